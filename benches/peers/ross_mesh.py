"""The mesh stiffness of tests/validation/ross-62-62.toml by ROSS: python ross_mesh.py.

Prints one JSON object: the seconds of gears and mesh, which contains the stiffness over a mesh
period (without the import), the number of places, the contact ratio, and the greatest and least
stiffness in N/m.
"""

import json
import time

import numpy as np
from ross import Material
from ross.gear_element import GearElementTVMS, Mesh

steel = Material(name="steel", rho=7810, E=206e9, Poisson=0.3)
gear = dict(material=steel, width=0.02, bore_diameter=0.035, module=2e-3, n_teeth=62, pr_angle=np.radians(20))

begin = time.perf_counter()
mesh = Mesh(GearElementTVMS(n=0, **gear), GearElementTVMS(n=1, **gear))
seconds = time.perf_counter() - begin
print(
    json.dumps(
        {
            "seconds": seconds,
            "points": len(mesh.theta_range),
            "contact_ratio": float(mesh.contact_ratio),
            "greatest": float(max(mesh.stiffness_range)),
            "least": float(min(mesh.stiffness_range)),
        }
    )
)
