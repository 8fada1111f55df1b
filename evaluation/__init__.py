"""Evidence, not product: models of rigs as FMUs, public recordings of systems, and cases with concealed effects."""
