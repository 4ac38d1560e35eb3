"""A gear pair as the methods `static` and `dynamic` see it: gap and stiffness of one pair of teeth along the line of action.

Written from model.md (sections 1, 3, 5) apart from the project's own code. SI units. `maths` is Python's `math` or
mpmath's `mp`, so that the same formulas serve in f64 and in 40 digits.

s counts along the line of action from E, in m; B lies at s = eps pb. For s < 0 the driven tip is on the driver's flank,
for s > eps pb the driver's tip on the driven flank.
"""

import math
import tomllib

from beam import Series, Tooth

UNITS = {
    "mm": 1e-3, "um": 1e-6, "deg": math.pi / 180, "GPa": 1e9, "kg/m3": 1.0, "N m": 1.0,
    "W": 1.0, "kW": 1e3, "rpm": math.pi / 30,
}
KUANG_YANG = (
    (3.867, 1.612, -0.02916, 0.0001553),
    (17.060, 0.7289, -0.01728, 0.0000999),
    (2.637, -1.222, 0.02217, -0.0001179),
    (-6.330, -1.033, 0.02068, -0.0001130),
)


def si(text):
    """'5 mm' as 0.005; a bare number as it is."""
    if not isinstance(text, str):
        return text
    number, unit = text.split(" ", 1)
    return float(number) * UNITS[unit]


class Gear:
    """Circles and material of one gear."""

    def __init__(self, table, module, alpha, maths):
        real = lambda key, default=None: maths.mpf(value) if (value := si(table.get(key, default))) is not None and maths is not math else value
        self.teeth = table["teeth"]
        self.shift = real("profile_shift", 0.0)
        self.width = real("face_width")
        self.young, self.poisson = real("young", 206e9), real("poisson", 0.3)
        self.density, self.bore = real("density", 7800.0), real("bore_radius", 0.0)
        self.tip_relief, self.root_relief = real("tip_relief", 0.0), real("root_relief", 0.0)
        self.tip_length, self.root_length = real("tip_relief_length"), real("root_relief_length")
        self.addendum, self.dedendum = real("addendum", 1.0), real("dedendum", 1.25)
        self.reference = module * self.teeth / 2
        self.base = self.reference * maths.cos(alpha)
        height = module * (self.addendum + self.shift) - real("tip_chamfer", 0.0)
        self.tip = self.reference + height
        self.tip_curvature = maths.sqrt((2 * self.reference * maths.sin(alpha / 2) ** 2 + height) * (self.tip + self.base))
        self.edge = real("tip_radius") or self.tip_curvature
        self.give = (1 - self.poisson**2) / self.young

    def inertia(self, pi):
        """Moment of inertia of the disc between bore and base circle, Eq. 47 corrected."""
        return pi * self.density * self.width / 2 * (self.base**4 - self.bore**4)

    def kuang_yang(self, module):
        """Eq. 56 as intercept and slope: 1/q = intercept + slope (radius - reference), N/m^2."""
        teeth = self.teeth
        a = [c[0] + c[1] * teeth + c[2] * teeth**2 + c[3] * teeth**3 for c in KUANG_YANG]
        slope = (a[2] + a[3] * self.shift) / ((1 + self.shift) * module)
        return 10**9 * (a[0] + a[1] * self.shift), 10**9 * slope


class Tip:
    """The tip of gear `tip` on the flank of gear `flank`, before its end of the line of action (model.md, section 3)."""

    def __init__(self, pair, tip, flank):
        self.maths, self.tip, self.flank = pair.maths, tip, flank
        self.centre = pair.centre
        self.working = pair.working
        self.start = pair.length - tip.tip_curvature
        self.gamma = self.maths.acos(tip.base / tip.tip) - pair.working

    def at(self, u):
        """(gap, radius on the flank, curvature radius of the flank, curvature arm of the tip) at the angle u of the tip's
        gear; everything an increment from the line of action, so that nothing is lost near it."""
        maths, flank, tip = self.maths, self.flank, self.tip
        half = maths.sin(u / 2)
        middle = self.gamma + u / 2
        grown = 4 * self.centre * tip.tip * half * maths.sin(middle)
        rho = maths.sqrt(self.start**2 + grown)
        growth = grown / (rho + self.start)
        turn = maths.atan2(flank.base * growth, flank.base**2 + rho * self.start)
        x, y = self.centre - tip.tip * maths.cos(self.gamma), tip.tip * maths.sin(self.gamma)
        across, up = 2 * tip.tip * half * maths.sin(middle), 2 * tip.tip * half * maths.cos(middle)
        polar = maths.atan2(x * up - y * across, x * x + y * y + x * across + y * up)
        chi = polar + turn
        gap = growth + tip.base * u - flank.base * chi
        arm = self.centre * maths.sin(self.working + chi) - rho
        return gap, maths.hypot(flank.base, rho), rho, arm


class Pair:
    """Geometry, masses, load, and gap and stiffness along the line of action."""

    def __init__(self, path, maths=math):
        with open(path, "rb") as file:
            case = tomllib.load(file)
        real = (lambda value: value) if maths is math else maths.mpf
        self.maths, pi = maths, maths.pi
        self.module = real(si(case["pair"]["module"]))
        alpha = real(si(case["pair"].get("pressure_angle", "20 deg")))
        self.driver = Gear(case["driver"], self.module, alpha, maths)
        self.driven = Gear(case["driven"], self.module, alpha, maths)
        one, two = self.driver, self.driven
        self.width = min(one.width, two.width)
        given = case["pair"].get("centre_distance")
        self.working = self.working_angle(alpha) if given is None else maths.acos((one.base + two.base) / real(si(given)))
        self.centre = (one.base + two.base) / maths.cos(self.working)
        self.length = (one.base + two.base) * maths.tan(self.working)
        self.pitch = pi * self.module * maths.cos(alpha)
        self.start, self.end = self.length - two.tip_curvature, one.tip_curvature
        self.path = self.end - self.start
        self.ratio = self.path / self.pitch
        operation = case["operation"]
        self.speed = real(si(operation["speed"]))
        torque = real(si(operation["torque"])) if "torque" in operation else real(si(operation["power"])) / self.speed
        self.force = torque / one.base
        self.velocity = self.speed * one.base
        deviations = case.get("deviations", {})
        # A backlash does not delay a drive flank under load.
        self.error = maths.sqrt(real(2)) * real(si(deviations.get("base_pitch", 0.0)))
        self.mass = 1 / (one.base**2 / one.inertia(pi) + two.base**2 / two.inertia(pi))
        model = case["model"]
        self.damping_ratio = model.get("damping_ratio", 0.07)
        self.warmup = model.get("warmup_cycles", 20)
        self.parabolic = model.get("relief_shape", "linear") == "parabolic"
        self.constant_contact = model.get("contact_compliance", "logarithmic") == "constant"
        self.run_in, self.run_out = Tip(self, two, one), Tip(self, one, two)
        self.teeth = self.beams(path) if model.get("tooth_compliance") == "beam" else (self.fit(one), self.fit(two))
        default = (self.ratio - maths.floor(self.ratio)) * self.pitch
        for gear in (one, two):
            gear.tip_length = gear.tip_length or default
            gear.root_length = gear.root_length or default
        self.relieved = any(gear.tip_relief or gear.root_relief for gear in (one, two))

    def fit(self, gear):
        """Compliance of a tooth by Eq. 56, of the load's radius and curvature radius."""
        stiffness, slope = gear.kuang_yang(self.module)
        return lambda radius, _: 1 / (stiffness + slope * (radius - gear.reference))

    def beams(self, path):
        """Compliance of the two teeth as beams, by f64 whatever the arithmetic; of the same arguments."""
        plain = self if self.maths is math else Pair(path)
        if plain is not self:
            return plain.teeth
        series = []
        for gear, other in ((self.driver, self.driven), (self.driven, self.driver)):
            tooth = Tooth(gear, self.module, math.acos(gear.base / gear.reference))
            least = self.length - other.tip_curvature
            series.append(Series(tooth, 0.98 * least, 1.02 * gear.tip_curvature))
        return tuple(lambda _, rho, one=one: one.at(rho) for one in series)

    def working_angle(self, alpha):
        """Working pressure angle of the mesh without backlash, by Newton on the involute function."""
        maths = self.maths
        inv = lambda t: maths.tan(t) - t
        target = inv(alpha) + 2 * (self.driver.shift + self.driven.shift) * maths.tan(alpha) / (self.driver.teeth + self.driven.teeth)
        angle = alpha
        for _ in range(60):
            angle -= (inv(angle) - target) / maths.tan(angle) ** 2
        return angle

    def reliefs(self):
        """(amount, length, distance from its end of the flank as a function of the two curvature radii)."""
        one, two = self.driver, self.driven
        return (
            (one.tip_relief, one.tip_length, lambda rho1, rho2: one.tip_curvature - rho1),
            (one.root_relief, one.root_length, lambda rho1, rho2: rho1 - self.start),
            (two.tip_relief, two.tip_length, lambda rho1, rho2: two.tip_curvature - rho2),
            (two.root_relief, two.root_length, lambda rho1, rho2: rho2 - (self.length - self.end)),
        )

    def relief(self, rho1, rho2):
        """Material ground off both flanks where their curvature radii are rho1 and rho2."""
        total = 0 * rho1
        for amount, length, distance in self.reliefs():
            left = 1 - distance(rho1, rho2) / length
            if amount and left > 0:
                total += amount * min(left, 1 + 0 * left) ** (2 if self.parabolic else 1)
        return total

    def place(self, s):
        """(separation S with relief in m, stiffness in N/m, sliding speed in m/s) of a pair at s."""
        one, two, maths = self.driver, self.driven, self.maths
        slide_two = self.velocity / two.base
        if s < 0:
            gap, radius1, rho1, arm = self.run_in.at(-s / two.base)
            radius2, rho2, edge1, edge2 = two.tip, two.tip_curvature, rho1, two.edge
            slide = slide_two * arm - self.speed * rho1
        elif s > self.path:
            gap, radius2, rho2, arm = self.run_out.at((s - self.path) / one.base)
            radius1, rho1, edge1, edge2 = one.tip, one.tip_curvature, one.edge, rho2
            slide = slide_two * rho2 - self.speed * arm
        else:
            gap = 0 * s
            rho1 = self.start + s
            rho2 = self.length - rho1
            radius1, radius2 = maths.hypot(one.base, rho1), maths.hypot(two.base, rho2)
            edge1, edge2 = rho1, rho2
            slide = slide_two * rho2 - self.speed * rho1
        if self.relieved:
            gap += self.relief(rho1, rho2)
        teeth = self.teeth[0](radius1, rho1) + self.teeth[1](radius2, rho2)
        return gap, self.width / (teeth + self.contact(edge1 * edge2 / (edge1 + edge2))), slide

    def contact(self, rho):
        """Contact compliance at the load F_0, Eq. 55 (or the constant of Yang & Sun), in m^2/N."""
        maths = self.maths
        give = self.driver.give + self.driven.give
        if self.constant_contact:
            return 2 * give / maths.pi
        half_width = maths.sqrt(4 * self.force / self.width * rho * give / maths.pi)
        return give / maths.pi * (1.27 + 0.781 * maths.log(self.module / half_width))

    def kinks(self, reach_in, reach_out):
        """Where along s a pair's separation or stiffness is not smooth: E, B, the ends of reliefs; and the pitch point,
        where the sliding turns."""
        points = [0.0, self.path, self.driver.base * math.tan(self.working) - self.start]
        inner = lambda u: self.run_in.at(u)[2]
        outer = lambda u: self.run_out.at(u)[2]
        for index, (amount, length, _) in enumerate(self.reliefs()):
            if not amount:
                continue
            on_line = [self.path - length, length, length, self.path - length][index]
            points.append(on_line)
            rho1 = [self.end - length, self.start + length, None, None][index]
            rho2 = [None, None, self.driven.tip_curvature - length, self.length - self.end + length][index]
            points += [-self.driven.base * u for u in crossing(inner, rho1, reach_in / self.driven.base)]
            points += [self.path + self.driver.base * u for u in crossing(outer, rho2, reach_out / self.driver.base)]
        return [point for point in points if -reach_in < point < self.path + reach_out]


def crossing(function, target, reach):
    """The argument in (0, reach) at which a rising function takes a value, as a list of none or one."""
    if target is None or not function(0.0) < target < function(reach):
        return []
    low, high = 0.0, reach
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) < target else (low, middle)
    return [low]
