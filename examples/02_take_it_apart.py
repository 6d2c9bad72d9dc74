"""In which order can five blocks be taken away so that what is left always stands?"""

import drystone as ds

scene = ds.scenes.five_blocks()
plan = ds.plan(scene)
print(plan)
plan.draw("order.svg")

# Any other order has to be checked step by step. This one takes the counterweight too early:
left = ["1", "2", "3", "4", "5"]
for name in ("4", "2", "5"):
    left.remove(name)
    verdict = ds.check(scene, left)
    print(f"without {name}: {'stands' if verdict.stable else 'falls'}")
