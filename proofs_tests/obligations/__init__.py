"""The table of obligations: what is proved or tested, where, how, on how many cases, and what its controls seed."""
