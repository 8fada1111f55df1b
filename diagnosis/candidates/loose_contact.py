"""A contact that becomes bad at an instant."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="loose_contact",
    name="contact that loosens at an instant",
    unit="electrical",
    law="R_string = R_string_0 + R_contact * step(t - instant)",
    source="R. Holm, Electric Contacts, 4th ed., Springer 1967, chapter 1",
    parameters=(
        Parameter(
            "R_contact",
            "ohm",
            0.0,
            10000.0,
            "passive: a contact gives no energy",
            meaning="resistance of the contact after the instant, in series with the string",
            plausible=10000.0,
            plausible_reason="an open contact is believed",
            starts=(0.14, 0.66, 3.06),
            starts_reason=(
                "those of a bad contact (contact_resistance): beyond them the current says no more than that it is open"
            ),
            is_amplitude=True,
        ),
        Parameter("instant", "s", -1000000.0, 1000000.0, "within the recordings", (10.0,)),
    ),
    places=("string",),
    lines={
        "string": "R_string += R_contact * share_after(instant, t_begin, t_end);",
    },
    signature="Current of one string drops at an instant and stays low by the same share; supply unchanged.",
    confused_with={
        "open_coil": "a partly open coil: its own heat or resistance decides",
        "contact_resistance": "the part before the instant decides",
    },
    scope_reason="a contact that came loose stays so until somebody tightens it",
)
