"""Force that repeats along the way: cogging of a motor, teeth, the pitch of a screw."""

from diagnosis.laws.law import Law, Number, Role

#: Waves along the way, in radians for each size of what the position moves by: from two periods within what it reaches
#: (a longer wave is a spring that bends), so close together that a fit from one of them finds what lies between.
_WAVES = tuple(round(3.0 + 0.7 * n, 1) for n in range(40))

LAW = Law(
    identifier="cogging",
    name="force that repeats along the way (cogging)",
    role=Role.VELOCITY,
    formula="amplitude * sin(wave_number * x + phase)",
    numbers=(
        Number("amplitude", "rate", "largest acceleration by it", (0.3,), 1000.0, None),
        Number("wave_number", "1/x", "radians of a period for each unit of the way", _WAVES, 40.0, 2.5),
        Number("phase", "x/x", "phase where the position is 0", (0.0, 1.6), 7.0, -7.0),
    ),
    source="first harmonic of a cogging torque: Hendershot and Miller, Design of Brushless Permanent-Magnet Machines, "
    "Motor Design Books 2010",
    confused_with={
        "cubic_spring": "more periods within the way decide, or a longer way",
        "unbalance": "its period decides: one turn, or a part of it",
    },
)
