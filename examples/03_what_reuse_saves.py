"""The same search with five stability tests: same answer, different work."""

import drystone as ds

scene = ds.scenes.random_stack(40)
for test in ("lp", "lp-warm", "lcp", "reuse-dantzig", "reuse"):
    plan = ds.plan(scene, test)
    assert plan.found
    milliseconds = 1e3 * plan.test_seconds
    print(f"{test:14} {plan.tests} tests  {plan.pivots:6} pivots  {milliseconds:8.2f} ms")
