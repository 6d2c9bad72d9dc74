"""What every room needs: text, files, arrays, cones, and who does what comes later."""
