"""Laws that a model may lack, by physical quantity: one file each, with no knowledge of any system."""
