"""Diagnosis of a fabric from its video beside diagnosis from the true places of its markers."""
