"""In which order can it be taken apart?"""
