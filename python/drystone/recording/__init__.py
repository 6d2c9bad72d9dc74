"""Plans, runs and scenes frame by frame: what pages play, and pictures of frames draw."""
