"""Resistance of a bad contact in a string."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="contact_resistance",
    name="contact resistance in a string",
    unit="electrical",
    law="R_string = R_string_0 + R_contact",
    source="R. Holm, Electric Contacts, 4th ed., Springer 1967, chapter 1",
    parameters=(
        Parameter(
            "R_contact",
            "ohm",
            0.0,
            50.0,
            "passive: a contact gives no energy",
            meaning="resistance of the contact, in series with the string",
            plausible=3.0,
            of="resistance",
            plausible_reason="a contact that takes the heat of three coils on its small surface burns or opens",
            is_amplitude=True,
        ),
    ),
    places=("string",),
    lines={
        "string": "R_string += R_contact;",
    },
    signature=(
        "Current of one string too small by the same share at all times; its coils cooler, none of "
        "them more than the others."
    ),
    confused_with={
        "base:reference_resistance": "all coils of the string higher look the same; the voltage of one coil decides",
        "supply_source_resistance": "acts on all strings; strings at different currents decide",
    },
)
