"""An arch in space, put up with one hand, and a wall whose bricks must be drawn out."""

import drystone as ds

# Any planar scene can be given a thickness; the contacts are then whole faces.
arch = ds.scenes.arch(voussoirs=15, thickness=0.3, friction=0.6).extruded(0.4)
print(ds.check(arch, cone="both"))

# Half an arch falls, so there is no order without help.
print(ds.plan(arch).status, "with no hand")
plan = ds.plan(arch, hold=1)
for what, block, step in plan.hold_steps[:4]:
    print(f"before {plan.order[step]} is taken away: {what} {block}")

# Every brick must also leave along a straight line past those that remain.
wall = ds.scenes.brick_wall(rows=4, columns=4)
plan = ds.plan(wall, clear_path=True)
print(plan.order[0], "leaves towards", plan.directions[0])
plan.draw("wall.html")  # turn it, cut it, draw the bricks apart
