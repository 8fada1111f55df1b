"""Systems of FMUs with concealed effects: truths by code of their own, recordings, answers."""
