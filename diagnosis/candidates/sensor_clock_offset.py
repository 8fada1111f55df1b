"""A channel whose clock is late."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="sensor_clock_offset",
    name="clock offset of a sensor",
    unit="measurement",
    law="value = truth(t - delay)",
    source="JCGM 200:2012, International Vocabulary of Metrology, and the definition of a time shift",
    parameters=(
        Parameter(
            "delay",
            "s",
            -10.0,
            10.0,
            "clocks are set within seconds",
            meaning="time by which the sensor's clock is late",
            plausible=5.0,
            plausible_reason=(
                "two quartz clocks of 20 ppm that are set each morning part by 3.5 s in the day; loggers that one "
                "person starts by hand one after the other are as far apart"
            ),
            is_amplitude=True,
            negligible=0.05,
        ),
    ),
    places=("channel", "quantity"),
    lines={
        "channel": "offset += delay;",
    },
    signature=(
        "Residual like the rate of change, largest right after switches, the same on all channels of one logger."
    ),
    confused_with={
        "sensor_lag": "sharp edges decide",
    },
    keeps_sums=True,
)
