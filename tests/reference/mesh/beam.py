"""Compliance of a tooth by Weber & Banaschek's energy method on its true profile in plane strain, with Sainsot's foundation
less the twist of the body about its bore (model.md, sections 6 and 9).

For teeth without undercut. The integrals are taken by SciPy's adaptive quadrature; along the flank the compliance is then
a Chebyshev series in the curvature radius of the involute, whose last terms are below 1e-13 of it.
"""

import math

from numpy.polynomial import chebyshev
from scipy.integrate import quad
from scipy.optimize import brentq

ROUNDING = 0.38
FOUNDATION = (
    (-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045),
    (60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086),
    (-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236),
    (-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904),
)
DEGREE = 44


class Tooth:
    """A tooth cut by a rack with a rounded tip, its centre line along x."""

    def __init__(self, gear, module, alpha):
        self.gear, self.alpha = gear, alpha
        sine, cosine = math.sin(alpha), math.cos(alpha)
        rounding = max(0.0, min(ROUNDING, (math.pi / 4 * cosine - gear.dedendum * sine) / (1 - sine)))
        self.rounding = rounding * module
        self.depth = (gear.dedendum - rounding - gear.shift) * module
        self.offset = (math.pi / 4 - gear.dedendum * sine / cosine - rounding * (1 - sine) / cosine) * module
        self.half_pitch = math.pi / gear.teeth
        self.half_angle = self.half_pitch / 2 + 2 * gear.shift * math.tan(alpha) / gear.teeth + math.tan(alpha) - alpha
        self.root = gear.reference + module * (gear.shift - gear.dedendum)
        self.junction = (gear.reference * sine - self.rounding - self.depth / sine) / gear.base
        if self.junction <= 0.0:
            raise ValueError("undercut tooth")

    def involute(self, roll):
        """(along, half thickness, d along/d roll)."""
        angle, base = roll - self.half_angle, self.gear.base
        sine, cosine = math.sin(angle), math.cos(angle)
        return base * (cosine + roll * sine), base * (roll * cosine - sine), base * roll * cosine

    def fillet(self, normal):
        """(along, half thickness, d along/d normal) where the rack's rounding touches with its normal at this angle: the
        rack's line rolls on the reference circle and every normal goes through the pitch point."""
        sine, cosine, radius = math.sin(normal), math.cos(normal), self.gear.reference
        reach = self.rounding + self.depth / sine
        turn = (self.offset - self.depth * cosine / sine) / radius - self.half_pitch
        across, up = -reach * cosine, radius - reach * sine
        half = across * math.cos(turn) - up * math.sin(turn)
        growth = -self.depth * cosine / sine**2
        across_slope, up_slope = -growth * cosine + reach * sine, -growth * sine - reach * cosine
        turning = self.depth / sine**2 / radius
        slope = across_slope * math.sin(turn) + up_slope * math.cos(turn) + turning * half
        return across * math.sin(turn) + up * math.cos(turn), half, slope

    def compliance(self, curvature):
        """m^2/N under a load where the involute has this curvature radius."""
        roll = curvature / self.gear.base
        angle = roll - self.half_angle
        sine, cosine = math.sin(angle), math.cos(angle)
        crossing = self.gear.base / cosine
        strain = 1 - self.gear.poisson**2

        def energy(section):
            x, h, slope = section
            moment = (crossing - x) * cosine
            shear = 1.2 * 2 * (1 + self.gear.poisson) * cosine**2
            return (strain * 1.5 * moment**2 / h**3 + (shear + strain * sine**2) / (2 * h)) * slope

        height = lambda t: self.involute(t)[0] - crossing
        ends = (self.half_angle, roll) if angle > 0 else (roll, 2 * self.half_angle - roll)
        last = brentq(height, *ends, xtol=1e-15, rtol=1e-15) if angle else roll
        within = {"epsabs": 0.0, "epsrel": 1e-13, "limit": 400}
        fillet = quad(lambda normal: -energy(self.fillet(normal)), self.alpha, math.pi / 2, **within)[0]
        flank = quad(lambda t: energy(self.involute(t)), self.junction, last, **within)[0]
        # Sainsot's coefficients are those of plane strain with nu = 0.3
        foundation = strain / 0.91 * self.foundation(sine, cosine)
        return (fillet + flank + foundation - self.twist() - self.shift()) / self.gear.young

    def body(self):
        """r_f/r_h within the range of the foundation; 3 for a gear without a bore."""
        return min(max(self.root / self.gear.bore if self.gear.bore else 3.0, 1.4), 7.0)

    def twist(self):
        """Displacement of all teeth by the twist of the body about its bore, times E."""
        return self.gear.base**2 / self.root**2 * (1 + self.gear.poisson) / (2 * math.pi) * (self.body() ** 2 - 1)

    def shift(self):
        """Displacement of a body without a bore, times E."""
        nu = self.gear.poisson
        c = (3 - 4 * nu) * (1 + nu) / (4 * math.pi * (1 - nu))
        return 0.0 if self.gear.bore else c * math.log(self.body())

    def foundation(self, sine, cosine):
        """Sainsot, Velex & Duverger 2004, times E."""
        theta = self.half_pitch - self.offset / self.gear.reference
        arm = (self.gear.base / cosine - self.root) / (2 * theta * self.root)
        body = self.body()
        t = min(max(theta, 0.01), 0.12)
        l, m, p, q = (
            a / t**2 + b * body**2 + c * body / t + d / t + e * body + f for a, b, c, d, e, f in FOUNDATION
        )
        return cosine**2 * (l * arm**2 + m * arm + p) + p * q * sine**2


class Series:
    """The compliance between two curvature radii."""

    def __init__(self, tooth, low, high):
        self.middle, self.half = (low + high) / 2, (high - low) / 2
        self.terms = chebyshev.chebinterpolate(self.sampled(tooth), DEGREE).tolist()
        if max(map(abs, self.terms[-3:])) > 1e-13 * self.terms[0]:
            raise ValueError("the series of the tooth's compliance has not settled")

    def sampled(self, tooth):
        return lambda nodes: [tooth.compliance(self.middle + self.half * node) for node in nodes]

    def at(self, curvature):
        """Clenshaw's sum, in whatever arithmetic the argument is."""
        t = (curvature - self.middle) / self.half
        last, before = 0, 0
        for term in reversed(self.terms[1:]):
            last, before = 2 * t * last - before + term, last
        return t * last - before + self.terms[0]
