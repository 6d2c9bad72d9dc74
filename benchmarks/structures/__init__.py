"""Random structures, the truth about them, and the proofs of verdicts, for random_structures.py."""
