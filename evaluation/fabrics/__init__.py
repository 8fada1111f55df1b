"""Blind draws of small fabrics: what the diagnosis says of truths that another engine made."""
