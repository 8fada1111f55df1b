"""Hand-made diagnoses, one for every verdict, and a series to draw."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.judge.diagnosis import (
    Adequacy,
    Alternative,
    ChannelFit,
    ChannelSpread,
    Diagnosis,
    Domain,
    Doubt,
    Estimate,
    Finding,
    Left,
    Moved,
    Searched,
    Spread,
    Standing,
    Used,
    Verdict,
)
from diagnosis.judge.isolability import Isolability
from diagnosis.judge.location import Dependence, Location, Remainder, Waveform
from diagnosis.judge.next_experiment import Course, NextExperiment, Rival
from diagnosis.report.series import Series

HOSTILE = "<script>alert('x')</script> & \"run\" \x1b[31m$x^2$"

CONTACT = Finding(
    unit="electrical",
    place="string[3]",
    elements=("string[3]", *(f"coil[3,{c}]" for c in range(1, 7))),
    intervals=((5.0, 42.5), (60.0, 88.0)),
    channels=("string[3].current", "supply.current"),
    effect="contact_resistance",
    is_named=True,
    statement="contact resistance in a string, string[3]",
    law="R_string = R_string_0 + R_contact",
    parameters=(Estimate("R_contact", "ohm", 0.31234, 0.28111, 0.34999),),
    gain=412.0,
    probability=0.93,
    ambiguous_with=("base:reference_resistance",),
    alternatives=(
        Alternative("contact_resistance", "string[3]", 412.0, 0.93),
        Alternative("supply_source_resistance", "supply", 390.0, 0.004),
    ),
    confused_with={
        "base:reference_resistance": "the voltage of one coil decides",
        "supply_source_resistance": "strings at different currents decide",
    },
)
MASS = replace(
    CONTACT,
    unit="thermal",
    place="coil[2,5]",
    elements=("coil[2,5]",),
    intervals=((10.0, 95.0),),
    channels=("coil[2,5].temperature",),
    effect="second_mass",
    statement="second thermal mass, coil[2,5]",
    law="C_2 * d(T_2) = G * (T - T_2)",
    ambiguous_with=(),
    confused_with={},
    alternatives=(),
    gain=88.0,
    parameters=(Estimate("C_2", "J/K", 0.05, 0.02, 0.08), Estimate("G", "W/K", 2.1e-5, 1.9e-5, 2.3e-5)),
)
UNNAMED = replace(
    MASS,
    place="all coils",
    elements=("coil[1,1]",),
    effect="unnamed_heat_square_excess",
    is_named=False,
    statement="unnamed term in heat: temperature above the surroundings, square",
    law="heat = heat_0 + a * x * x",
    standing=Standing.UNNAMED,
)
LAG = replace(
    MASS,
    unit="measurement",
    place="coil[1,2].temperature",
    elements=("coil[1,2]",),
    effect="sensor_lag",
    channels=("coil[1,2].temperature",),
    statement="sensor lag, coil[1,2].temperature",
    law="tau * d(y) = x - y",
)
FINDINGS = {
    Verdict.CONSISTENT: (),
    Verdict.RECALIBRATED: (),
    Verdict.RECORDING_FAULT: (),
    Verdict.MEASUREMENT_FAULT: (LAG,),
    Verdict.MISSING_PHYSICS: (CONTACT, MASS),
    Verdict.UNNAMED_PHYSICS: (UNNAMED,),
    Verdict.CANNOT_TELL: (),
}


ADEQUACY = Adequacy(
    basis="held-out recordings",
    is_rejected=True,
    chi_square={"before": 81.0, "recalibrated": 16.0, "after": 4.0},
    limit=1.08,
    explained=0.9625,
    by_recalibration=0.8125,
    worst=Left("steps", "coil[2,5].temperature", "K", 1.2, 0.15, 64.0, 1.3),
    rejected=(3, 42),
    day=(Moved("ambient_offset of recording 1", "K", 0.31, False, 0.62),),
    wild=2,
    is_noise_stated=True,
    is_nominal_rejected=True,
    is_training_rejected=False,
    is_recalibration_worse=False,
)
DOUBT = Doubt(
    "steps",
    "supply.voltage",
    "programme",
    "The supply switches at 30 s, the readings at 50 s.",
    "Give the programme of that day.",
    True,
    0.0,
    100.0,
    40.0,
)


EXPERIMENT = NextExperiment(
    scenario="out/next_experiment/scenario.yaml",
    kind="staircase",
    statement="Staircase for 60 s would decide.",
    rivals=(Rival(("contact_resistance at string[3]",), 0.6), Rival(("supply_source_resistance at supply",), 0.4)),
    courses=(Course("supply", "voltage", "V", (0.0, 3.0, 40.0), ((0.0, 0.0), (6.0, 3.0), (0.0, 0.0))),),
    duration=60.0,
    limits=("supply.voltage from 0 to 6 V",),
    log_bayes_factor=8.25,
    repeat_log_bayes_factor=0.0625,
    decides=0.875,
    repeat_decides=0.125,
    channel="string[3].current",
    best_time=12.5,
    tried=17,
)


def fit(channel: str, unit: str, size: float, is_held_out: bool, title: str = "steps") -> ChannelFit:
    stages = {"before": 9.0 * size, "recalibrated": 4.0 * size, "after": size}
    return ChannelFit(
        title,
        is_held_out,
        channel,
        unit,
        stages,
        {k: (v / size) ** 2 for k, v in stages.items()},
        {"before": 30.0, "recalibrated": 12.0, "after": 2.5},
    )


def diagnosis(verdict: Verdict, title: str = "steps") -> Diagnosis:
    fits = [
        fit(f"coil[{s},{c}].temperature", "K", 0.3, h, title)
        for h in (False, True)
        for s in range(1, 7)
        for c in range(1, 7)
    ]
    fits += [fit(f"string[{s}].current", "A", 0.003, True, title) for s in range(1, 7)]
    return Diagnosis(
        verdict=verdict,
        statement=f"The answer is {verdict.value}.",
        findings=FINDINGS[verdict],
        fit=tuple(fits),
        margin=12.0,
        false_alarm_rate=0.002,
        structure_before=-21.4,
        structure_after=3.1,
        recalibration=(Moved("convection", "1", 1.083, True, 2.4), Moved("shift", "K", -1.6, False, -3.0)),
        isolability=Isolability(("Heat and stiffness cannot be told apart without a temperature.",)),
        amended_model="out/amended/scenario.yaml",
        seconds=14.2,
        simulations=5321,
        seed=7,
        scenario="rig/scenario.yaml",
        recordings=(Used(title, "rig/monday", False, 0.0, 100.0, ("coil[2,5].temperature",)),),
        spread=(ChannelSpread("coil[2,5].temperature", "K", True, 2, 400, *({"after": Spread(1.0, 0.9, 1.1)},) * 3),),
        left=(Remainder("coil[4,4].temperature", 30.0, 42.0, 7.7, 4.9),) if verdict is Verdict.CANNOT_TELL else (),
        locations=(
            Location(
                "thermal",
                "heat balance",
                "coil[2,5]",
                "coil[2,5].temperature",
                10.0,
                14.0,
                -9.25,
                4.6,
                title,
                (Dependence("current", 0.81),),
            ),
        ),
        waveforms=(
            Waveform(
                "W",
                "heat balance",
                "coil[2,5]",
                (0.0, 1.0),
                (0.01, 0.02),
                (0.0, 0.01),
                (0.02, 0.03),
                title,
                1,
                (0.01, 0.02),
            ),
        )
        if verdict is Verdict.MISSING_PHYSICS
        else (),
        next_experiment=EXPERIMENT if verdict is Verdict.MISSING_PHYSICS else None,
        adequacy=None if verdict is Verdict.RECORDING_FAULT else ADEQUACY,
        searched=Searched((Domain("thermal", 30, 12, 37),), ("`plant` (fmu) offers no place for a law",)),
        doubts=(DOUBT,) if verdict is Verdict.RECORDING_FAULT else (),
    )


def series(channel: str = "coil[2,5].temperature", unit: str = "K", base: float = 300.0) -> Series:
    times = np.linspace(0.0, 100.0, 201)
    truth = base * (1.0 + 0.2 * (1.0 - np.exp(-times / 20.0)))
    noise = 1e-3 * base * np.random.default_rng(1).standard_normal(201)
    return Series(channel, unit, times, truth + noise, truth * 0.97, truth * 0.99, truth, 1e-3 * base, "steps", True)
