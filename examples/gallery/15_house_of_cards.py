"""Two cards

Only corners meet at the top. There is a contact with the normal that slightly rounded corners
have, and with enough friction the two hold each other up.
"""

from math import hypot

import drystone as ds

scene = ds.Scene(friction=0.6)
scene.add_box((0, -0.5), (6, 1), name="ground", fixed=True)
for side, name in ((1, "right"), (-1, "left")):
    foot, top = (side * 1.1, 0.0), (0.0, 2.4)
    x, y = side * 2.4 / hypot(1.1, 2.4), 1.1 / hypot(1.1, 2.4)  # across the card, outwards
    card = [foot, (foot[0] + 0.08 * x, 0.08 * y), (0.08 * x, top[1] + 0.08 * y), top]
    scene.add_polygon(card if side > 0 else card[::-1], name=name)
ds.check(scene).draw("15_house_of_cards.svg")
