"""Systems of FMUs: small models of rigs, written and compiled here."""
