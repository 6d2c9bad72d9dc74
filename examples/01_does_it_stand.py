"""A plank leans over its pier. Does it stand? And with a counterweight?"""

import drystone as ds

scene = ds.Scene(friction=0.5)
scene.add_box((0.0, 0.5), (1.0, 1.0), name="pier", fixed=True)
scene.add_box((0.6, 1.1), (2.0, 0.2), name="plank")

verdict = ds.check(scene)
print(verdict)
across, down, turn = verdict.acceleration("plank")
print(f"the plank begins to turn at {turn:.2f} rad/s^2, its middle to move at {down:.2f} m/s^2")
verdict.draw("falls.svg")

scene.add_box((0.0, 1.6), (0.8, 0.8), name="counterweight")
verdict = ds.check(scene)
print(verdict)
for force in verdict.forces:
    x, y = force.point
    print(f"{force.a} pushes {force.b} at ({x:.1f}, {y:.1f}) with {force.normal_force:.2f} N")
verdict.draw("stands.svg")
