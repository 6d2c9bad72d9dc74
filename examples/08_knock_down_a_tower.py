"""A tower of bricks in space stands to the bit, until a thrown block hits it."""

import drystone as ds

tower = ds.Scene(dimension=3, friction=0.5)
tower.add_box((0, 0, -0.5), (40, 40, 1), name="ground", fixed=True)
for course in range(5):
    for brick in range(2):
        shift = 0.5 * brick - 0.25
        across = course % 2 == 1
        center = (0, shift, course + 0.5) if across else (shift, 0, course + 0.5)
        size = (1, 0.5, 1) if across else (0.5, 1, 1)
        tower.add_box(center, size, name=f"{course}-{brick}", density=500)
print(ds.check(tower))

# While nothing moves a step costs microseconds, and no place changes by a bit.
world = ds.World(tower)
still = world.run(480)
print(still)
assert (still.poses == still.poses[0]).all()

# A small, heavy block, thrown from the left at half height: what it hits gives way.
world.add_box((-4, 0.1, 2.5), (0.4, 0.4, 0.4), name="thrown", density=8000)
world.set_velocity("thrown", (12, 0, 1.5, 0, 2, 0))
fall = world.run(480, forces=True)
print(fall)
print(f"deepest overlap {fall.penetration.max():.1e} m")
fall.view().save("knocked.html")  # turn it while it plays
