"""Transformation temperatures that wander with every cycle."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State

CANDIDATE = CandidateTerm(
    identifier="fatigue_shift",
    name="transformation temperatures that wander with cycling",
    unit="stiffness",
    law="shift = wander * cycles; d(cycles) = 0.5 * abs(d(phase))",
    source=(
        "G. Eggeler et al., Structural and functional fatigue of NiTi shape memory alloys, Mater. "
        "Sci. Eng. A 378 (2004) 24-33"
    ),
    parameters=(
        Parameter(
            "wander",
            "K",
            -5.0,
            5.0,
            "a few kelvins over the first cycles, either way",
            meaning="shift of the transformation temperatures in a full cycle",
            plausible=3.0,
            plausible_reason=(
                "untrained wire moves by about 25 K in all, most of it in ten cycles: 2.5 K in the first, less in "
                "each one after it (S. Miyazaki, Y. Igo and K. Otsuka, Acta Metall. 34 (1986) 2045-2051; Eggeler et "
                "al. 2004)"
            ),
            is_amplitude=True,
        ),
    ),
    places=("all", "coil"),
    lines={
        "stiffness": "shift += wander * cycles;",
        "accept": """
            cycles += 0.5 * fabs(phase - phase_last);
            phase_last = phase;
        """,
    },
    signature="The loop moves along the temperature from cycle to cycle.",
    confused_with={
        "fatigue": "the plateau when hot decides",
        "sensor_drift": "a soak decides",
    },
    states=(State("cycles", "1", "cycles_before", "memory"), State("phase_last", "1", "phase", "memory")),
)
