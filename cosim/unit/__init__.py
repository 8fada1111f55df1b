"""What a unit is: protocol, variables, physical quantities, errors; it imports nothing else of this tree."""
