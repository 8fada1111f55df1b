"""Laws that are in no catalogue, composed at random from shapes and memories over the variables of a rig."""
