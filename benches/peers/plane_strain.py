"""Compliance of a tooth by gmsh and scikit-fem, without contact: python plane_strain.py [SIZE [TEETH ...]], z 20.

Plane strain on the whole gear, clamped at the bore, six loads on a flank: the gears of tests/reference/field, by
triangles of second order with curved edges. SIZE is the length of the edges at the loaded flank, in modules. Prints
one JSON object for each gear: seconds of mesh, assembly and solution (without the imports), unknowns, and the
greatest error against teeth.json.
"""

import json
import pathlib
import sys
import tempfile
import time

import gmsh
import numpy as np
import scipy.sparse.linalg as linalg
from scipy import spatial
from skfem import Basis, ElementTriP2, ElementVector, MeshTri2
from skfem.models.elasticity import linear_elasticity

ROWS = pathlib.Path(__file__).resolve().parent.parent.parent / "tests/reference/field/teeth.json"


def shapes(x, y):
    """The functions of a triangle of second order, in the order of scikit-fem, and their derivatives."""
    rest = 1 - x - y
    of = [rest * (2 * rest - 1), x * (2 * x - 1), y * (2 * y - 1), 4 * rest * x, 4 * x * y, 4 * rest * y]
    along_x = [1 - 4 * rest, 4 * x - 1, 0 * x, 4 * (rest - x), 4 * y, -4 * y]
    along_y = [1 - 4 * rest, 0 * x, 4 * y - 1, -4 * x, 4 * x, 4 * (rest - y)]
    return np.array(of), np.array(along_x), np.array(along_y)


def probe(basis, places):
    """The elements at places, as columns, and their functions there: scikit-fem has none for a curved mesh."""
    grid, count = basis.mesh, places.shape[1]
    _, near = spatial.cKDTree(grid.p[:, grid.t].mean(axis=1).T).query(places.T, k=12)
    corners = grid.doflocs[:, grid.dofs.element_dofs][:, :, near]
    sums = lambda parts: np.einsum("ikpn,kpn->ipn", corners, parts)
    x, y = np.full((2, *near.shape), 1 / 3)
    for _ in range(8):
        of, along_x, along_y = shapes(x, y)
        (right, up), (a, c), (b, d) = places[:, :, None] - sums(of), sums(along_x), sums(along_y)
        determinant = a * d - b * c
        x, y = x + (d * right - b * up) / determinant, y + (a * up - c * right) / determinant
    inside = np.nan_to_num(np.minimum(np.minimum(x, y), 1 - x - y), nan=-1)
    best = np.arange(count), inside.argmax(axis=1)
    assert inside[best].min() > -0.02
    return basis.element_dofs[:, near[best]], shapes(x[best], y[best])[0]


def vector(basis, places, forces):
    """The loads at the nodes of a force at each place."""
    dofs, of = probe(basis, places)
    found = np.zeros(basis.N)
    for axis in range(2):
        np.add.at(found, dofs[axis::2], of * forces[axis])
    return found


def outline(gear, points):
    """Half a space and half a tooth, from the middle of the space to the tip corner, in modules: polar angles from the
    middle of the tooth and radii of the fillet and of the involute."""
    z, x, alpha = gear["teeth"], gear["profile_shift"], np.radians(gear["pressure_angle_deg"])
    reference, rounding = z / 2, gear["tip_rounding"]
    base, tip = reference * np.cos(alpha), reference + gear["addendum"] + x
    depth = gear["dedendum"] - rounding - x
    centre = np.pi / 4 - (gear["dedendum"] - rounding) * np.tan(alpha) - rounding / np.cos(alpha)
    # the centre of the rack's rounding rolls on the reference circle; its normal passes the pitch point
    roll = np.linspace(0, depth / np.tan(alpha), points)
    away = np.hypot(roll, depth)
    across, along = roll * (1 + rounding / away), reference - depth * (1 + rounding / away)
    turn = (roll - centre) / reference
    angles = np.arctan2(across, along) - turn
    radii = np.hypot(across, along)
    pitch_half = np.pi / 2 / z + 2 * x * np.tan(alpha) / z
    involute = lambda radius: np.tan(np.arccos(base / radius)) - np.arccos(base / radius)
    half = lambda radius: pitch_half + np.tan(alpha) - alpha - involute(radius)
    flank = base * np.hypot(1, np.linspace(np.sqrt((radii[-1] / base) ** 2 - 1), np.sqrt((tip / base) ** 2 - 1), points))
    return base, half, (np.pi / z - angles, radii), (half(flank), flank)


def mesh(gear, size):
    base, half, fillet, flank = outline(gear, 21)
    z, bore = gear["teeth"], gear["bore_radius"]
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    add = gmsh.model.geo
    point = lambda angle, radius, edge: add.addPoint(radius * np.sin(angle), radius * np.cos(angle), 0, edge)
    curves, last = [], None
    for tooth in range(z):
        middle = 2 * np.pi * tooth / z
        edge = size if tooth == 0 else 1.2
        # clockwise: rising on the left side, falling on the right; the loaded flank is the right one
        rise = [(middle - a, r) for a, r in zip(*fillet)], [(middle - a, r) for a, r in zip(*flank)][1:]
        fall = [(middle + a, r) for a, r in zip(*flank)][::-1], [(middle + a, r) for a, r in zip(*fillet)][-2::-1]
        left = edge if tooth else 3 * size
        tags = [[point(*at, 4 * size if tooth == 0 else edge) for at in rise[0]], [point(*at, left) for at in rise[1]],
                [point(*at, edge) for at in fall[0]], [point(*at, 2 * edge if tooth == 0 else edge) for at in fall[1]]]
        if last:
            curves.append(add.addLine(last, tags[0][0]))
        else:
            first = tags[0][0]
        curves.append(add.addSpline(tags[0]))
        curves.append(add.addSpline([tags[0][-1], *tags[1]]))
        curves.append(add.addLine(tags[1][-1], tags[2][0]))
        curves.append(add.addSpline(tags[2]))
        curves.append(add.addSpline([tags[2][-1], *tags[3]]))
        last = tags[3][-1]
    curves.append(add.addLine(last, first))
    origin = add.addPoint(0, 0, 0)
    circle = [point(np.pi / 2 * quarter, bore, bore / 3) for quarter in range(4)]
    inside = [add.addCircleArc(circle[at], origin, circle[(at + 1) % 4]) for at in range(4)]
    surface = add.addPlaneSurface([add.addCurveLoop(curves), add.addCurveLoop(inside)])
    add.synchronize()
    gmsh.model.addPhysicalGroup(2, [surface])
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/gear.msh"
        gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
        gmsh.write(path)
        gmsh.finalize()
        return base, half, MeshTri2.load(path)


def compliances(rows, size):
    gear = rows[0]
    base, half, grid = mesh(gear, size)
    basis = Basis(grid, ElementVector(ElementTriP2()))
    poisson = gear["poisson"]
    stiffness = linear_elasticity(poisson / ((1 + poisson) * (1 - 2 * poisson)), 1 / (2 * (1 + poisson))).assemble(basis)
    clamped = basis.get_dofs(lambda at: np.hypot(*at) < gear["bore_radius"] * (1 + 1e-3))
    loads, measured = [], []
    for row in rows:
        radius, a = row["radius"], row["patch_half_width"]
        roll = np.sqrt((radius / base) ** 2 - 1)
        # an elliptical pressure along the flank: s = a sin t with the weight cos² t
        t = (np.arange(8) + 0.5) / 8 * np.pi - np.pi / 2
        # ds = r_b φ dφ along the involute
        rolls = np.sqrt(roll**2 + 2 * a * np.sin(t) / base)
        weights = np.cos(t) ** 2 / np.sum(np.cos(t) ** 2)
        radii = base * np.hypot(1, rolls)
        angles = half(radii)
        # towards the centre of the tooth, along the tangent to the base circle at the middle of the patch
        foot = half(radius) - np.arccos(base / radius)
        force = np.array([-np.cos(foot), np.sin(foot)])
        places = np.array([radii * np.sin(angles), radii * np.cos(angles)])
        middle = radius * np.array([np.sin(half(radius)), np.cos(half(radius))])
        centre = middle + force * (middle[0] / -force[0])
        loads.append(vector(basis, places, force[:, None] * weights))
        measured.append(vector(basis, centre[:, None], force[:, None]))
        assert abs(np.hypot(*(centre - middle)) - row["depth"]) < 1e-5
    free = basis.complement_dofs(clamped)
    matrix = stiffness[free][:, free].tocsc()
    solve = linalg.splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    moved = solve.solve(np.array(loads)[:, free].T)
    return len(free), [float(one[free] @ moved[:, at]) for at, one in enumerate(measured)]


def main(size, teeth):
    gears = {}
    for row in json.loads(ROWS.read_text()):
        gears.setdefault((row["teeth"], row["pressure_angle_deg"]), []).append(row)
    for key, rows in gears.items():
        if key[0] not in teeth:
            continue
        begin = time.perf_counter()
        unknowns, found = compliances(rows, size)
        seconds = time.perf_counter() - begin
        error = max(abs(one / row["qE_depth"] - 1) for one, row in zip(found, rows))
        print(json.dumps({"teeth": key[0], "seconds": seconds, "unknowns": unknowns, "error": error}))


main(float(sys.argv[1]) if sys.argv[1:] else 0.1, [int(one) for one in sys.argv[2:]] or [20])
