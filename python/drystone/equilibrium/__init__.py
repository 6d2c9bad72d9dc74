"""Does it stand, how much more does it bear, and how far is it from falling?"""
