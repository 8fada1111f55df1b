"""What fabrics of chainmail alone need: equations, figures, ensembles, designs, cameras, moving pictures."""
