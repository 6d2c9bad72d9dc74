"""A column falls apart, after Fig. 1 of Loomis and Balkcom: what moves when, what reuse saves."""

import drystone as ds

scene = ds.scenes.falling_column()
runs = {
    reuse: ds.simulate(scene, steps=700, reuse=reuse) for reuse in ("none", "motionless", "full")
}

run = runs["full"]
before = None
for step, still in enumerate(run.motionless):
    moving = " ".join(name for name, rests in zip(run.names, still, strict=True) if not rests)
    if moving != before:
        print(f"from {step * run.dt:5.3f} s moves {moving or 'nothing'}")
        before = moving

for reuse, record in runs.items():
    print(f"reuse {reuse:10} {record.pivots.sum():6} pivots in {record.solves.sum()} solves")
run.save("falling_column.npz")
