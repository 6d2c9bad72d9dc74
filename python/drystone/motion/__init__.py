"""How does it move?"""
