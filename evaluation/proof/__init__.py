"""Proof of the diagnosis on concealed effects: cases of the proving ground, diagnosed apart, scored, tabulated."""
