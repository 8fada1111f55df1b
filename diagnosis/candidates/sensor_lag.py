"""A sensor that follows slowly."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="sensor_lag",
    name="lag of a sensor",
    unit="measurement",
    law="lag_time * d(value) = truth - value",
    source=("E. O. Doebelin, Measurement Systems, 5th ed., McGraw-Hill 2003, section 3.3 (first-order instrument)"),
    parameters=(
        Parameter(
            "lag_time",
            "s",
            0.0,
            60.0,
            "a sensor follows, it does not foresee",
            meaning="time constant of the sensor",
            plausible=30.0,
            plausible_reason=(
                "a sheathed thermocouple of 3 mm in still air has some tens of seconds (Doebelin, section 3.3); "
                "a stated bound takes its place"
            ),
            is_amplitude=True,
            negligible=0.05,
        ),
    ),
    places=("channel", "quantity"),
    lines={
        "channel": "lag += lag_time;",
    },
    signature="Rounded corners at switches; slow parts delayed.",
    confused_with={
        "sensor_clock_offset": "sharp edges decide",
        "second_mass": "stiffness or current decide",
    },
    keeps_sums=True,
)
