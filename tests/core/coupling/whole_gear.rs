//! A whole gear in plane strain with other finite elements than the program: eight-node elements,
//! every sector condensed to its two cuts and all sectors joined in one ring, without harmonics and
//! without the symmetry of a tooth.
use std::collections::HashMap;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix3, Point2, SMatrix, Vector2};
use tipstrike::model::Outline;
use tipstrike::model::outline::Piece;

/// Number of elements across a tooth; then along the lower and upper half of its fillet and along
/// its flank, over half of a space, and from the root to the bore.
const ACROSS: usize = 6;
const LOW: usize = 3;
const HIGH: usize = 3;
const FLANK: usize = 7;
const SPACE: usize = 2;
const DEPTH: usize = 6;

/// Tooth and body of a gear under a unit force on a flank, per unit width and for Young's modulus
/// 1.
pub(crate) struct WholeGear {
    outline: Outline,
    sectors: usize,
    poisson: f64,
    bore: f64,
    places: Vec<Point2<f64>>,
    /// Nodes of the loaded flank, from the root to the tip.
    flank: Vec<usize>,
    /// Indices of the free components of each node among the inner components.
    inner: HashMap<usize, usize>,
    factored: Cholesky<f64, Dyn>,
    /// Transformation from the components of the cuts to the inner components.
    to_cuts: DMatrix<f64>,
    ring: Cholesky<f64, Dyn>,
}

/// A unit force on the flank of one tooth, or the displacement along its line.
pub(crate) struct Line {
    /// Its inner components.
    vector: DVector<f64>,
    /// The inner displacements that it causes with fixed cuts.
    held: DVector<f64>,
    /// The force that it transmits to the cuts.
    passed: DVector<f64>,
}

impl WholeGear {
    pub(crate) fn new(outline: Outline, sectors: u32, bore: f64, poisson: f64) -> WholeGear {
        let mut mesh = Mesh { outline, bore, places: Vec::new(), known: HashMap::new() };
        let elements = mesh.elements();
        let flank = (0..=2 * FLANK).map(|at| {
            let place = mesh.tooth(2 * ACROSS, 2 * HIGH + at);
            mesh.node(place)
        });
        let flank: Vec<usize> = flank.collect();
        let cut = |mesh: &mut Mesh, side: usize| -> Vec<usize> {
            let places = (1..=2 * DEPTH).map(|level| mesh.rim(side, level));
            let places: Vec<_> = places.collect();
            places.into_iter().map(|place| mesh.node(place)).collect()
        };
        let cuts = [cut(&mut mesh, 0), cut(&mut mesh, 2 * AROUND)];
        let places = mesh.places;
        let stiffness = assembled(&places, &elements, poisson);
        let is_on_cut = |node: &usize| cuts.iter().any(|cut| cut.contains(node));
        let is_on_bore = |node: &usize| places[*node].coords.norm() < bore * (1.0 + 1e-9);
        let free = (0..places.len()).filter(|node| !is_on_cut(node) && !is_on_bore(node));
        let inner: HashMap<usize, usize> =
            free.enumerate().map(|(at, node)| (node, 2 * at)).collect();
        let mut columns = vec![0; 2 * inner.len()];
        for (node, at) in &inner {
            (columns[*at], columns[at + 1]) = (2 * node, 2 * node + 1);
        }
        // Radial and tangential components are common to both neighbours of a cut.
        let count = 2 * cuts[0].len();
        let mut turn = DMatrix::zeros(stiffness.nrows(), 2 * count);
        for (at, &node) in cuts.iter().flatten().enumerate() {
            let along = places[node].coords.normalize();
            for (component, direction) in
                [along, Vector2::new(-along.y, along.x)].iter().enumerate()
            {
                turn[(2 * node, 2 * at + component)] = direction.x;
                turn[(2 * node + 1, 2 * at + component)] = direction.y;
            }
        }
        let turned = &stiffness * &turn;
        let inner_inner = stiffness.select_columns(&columns).select_rows(&columns);
        let to_cuts = turned.select_rows(&columns);
        let factored = inner_inner.cholesky().expect("a stiff sector");
        let condensed = turn.transpose() * &turned - to_cuts.transpose() * factored.solve(&to_cuts);
        let sectors = sectors as usize;
        let mut ring = DMatrix::zeros(sectors * count, sectors * count);
        for sector in 0..sectors {
            let starts = [sector, (sector + 1) % sectors].map(|cut| cut * count);
            for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let mut block = ring.view_mut((starts[row], starts[column]), (count, count));
                block += condensed.view((row * count, column * count), (count, count));
            }
        }
        WholeGear {
            outline,
            sectors,
            poisson,
            bore,
            places,
            flank,
            inner,
            factored,
            to_cuts,
            ring: ring.cholesky().expect("a stiff ring"),
        }
    }

    /// A unit force at a radius, along the tangent to the base circle.
    pub(crate) fn line(&self, radius: f64) -> Line {
        let mut vector = DVector::zeros(2 * self.inner.len());
        for (node, share) in self.shares(radius) {
            let at = self.inner[&node];
            let force = self.force_at(radius) * share;
            (vector[at], vector[at + 1]) = (force.x, force.y);
        }
        let held = self.factored.solve(&vector);
        let passed = -(self.to_cuts.transpose() * &held);
        Line { vector, held, passed }
    }

    /// Displacement along one line by the force on another, which acts `pitches` further
    /// anticlockwise; the force pushes clockwise. Without the twist of the body.
    pub(crate) fn displacement(&self, measured: &Line, loaded: &Line, pitches: i32) -> f64 {
        let count = loaded.passed.len() / 2;
        let mut force = DVector::zeros(self.sectors * count);
        let start = pitches.rem_euclid(self.sectors.cast_signed() as i32) as usize;
        let starts = |sector: usize| [sector, (sector + 1) % self.sectors].map(|cut| cut * count);
        for (half, at) in starts(start).into_iter().enumerate() {
            let mut part = force.rows_mut(at, count);
            part += loaded.passed.rows(half * count, count);
        }
        let moved = self.ring.solve(&force);
        let halves = starts(0).into_iter().enumerate();
        let by_cuts: f64 = halves
            .map(|(half, at)| measured.passed.rows(half * count, count).dot(&moved.rows(at, count)))
            .sum();
        let own = if start == 0 { measured.vector.dot(&loaded.held) } else { 0.0 };
        own + by_cuts - self.twist()
    }

    /// Displacement of every tooth by the twist of a ring from the bore to the root circle.
    fn twist(&self) -> f64 {
        let circles = self.outline.profile().circles();
        let rest = self.bore.powi(-2) - circles.root.powi(-2);
        circles.base * circles.base * (1.0 + self.poisson) / std::f64::consts::TAU * rest
    }

    /// Into the tooth and clockwise, with the base radius as lever arm.
    fn force_at(&self, radius: f64) -> Vector2<f64> {
        let place = self.place_at(radius);
        let along = place.coords / radius;
        let cosine = self.outline.profile().circles().base / radius;
        let clockwise = Vector2::new(along.y, -along.x);
        clockwise * cosine - along * (1.0 - cosine * cosine).sqrt()
    }

    fn place_at(&self, radius: f64) -> Point2<f64> {
        let shares = self.shares(radius);
        shares
            .iter()
            .fold(Point2::origin(), |sum, (node, share)| sum + self.places[*node].coords * *share)
    }

    /// The three nodes of the edge of the flank at a radius, with their shape functions.
    fn shares(&self, radius: f64) -> [(usize, f64); 3] {
        let radius_of = |at: usize| self.places[self.flank[at]].coords.norm();
        let edge = (0..FLANK).find(|edge| radius <= radius_of(2 * edge + 2)).unwrap_or(FLANK - 1);
        let nodes = [0, 1, 2].map(|at| self.flank[2 * edge + at]);
        let shares = |t: f64| [0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)];
        let off = |t: f64| {
            let place = nodes.iter().zip(shares(t)).fold(Vector2::zeros(), |sum, (node, share)| {
                sum + self.places[*node].coords * share
            });
            place.norm() - radius
        };
        let (mut low, mut high) = (-1.0, 1.0);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            if off(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let shares = shares(low);
        [0, 1, 2].map(|at| (nodes[at], shares[at]))
    }
}

/// Elements around a pitch.
const AROUND: usize = ACROSS + 2 * (LOW + SPACE);

struct Mesh {
    outline: Outline,
    bore: f64,
    places: Vec<Point2<f64>>,
    known: HashMap<(i64, i64), usize>,
}

impl Mesh {
    fn node(&mut self, place: Point2<f64>) -> usize {
        const GRAIN: f64 = 1e-9;
        let key = ((place.x / GRAIN).round() as i64, (place.y / GRAIN).round() as i64);
        let next = self.places.len();
        let node = *self.known.entry(key).or_insert(next);
        if node == next {
            self.places.push(place);
        }
        node
    }

    /// The nodes of every element: corners, then midpoints of the edges.
    fn elements(&mut self) -> Vec<[usize; 8]> {
        const PLACES: [(usize, usize); 8] =
            [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)];
        let mut elements = Vec::new();
        for (across, up) in grid(ACROSS, HIGH + FLANK) {
            elements.push(PLACES.map(|(y, x)| {
                let place = self.tooth(2 * across + x, 2 * up + y);
                self.node(place)
            }));
        }
        for (around, up) in grid(AROUND, DEPTH) {
            elements.push(PLACES.map(|(y, x)| {
                let place = self.rim(2 * around + x, 2 * up + y);
                self.node(place)
            }));
        }
        elements
    }

    /// A point of the tooth, in half elements across (clockwise flank first) and up.
    fn tooth(&self, across: usize, up: usize) -> Point2<f64> {
        let edge = if up <= 2 * HIGH {
            self.outline.at(Piece::Fillet, 0.5 + 0.5 * up as f64 / (2 * HIGH) as f64)
        } else {
            self.outline.at(Piece::Flank, (up - 2 * HIGH) as f64 / (2 * FLANK) as f64)
        };
        Point2::new(edge.x, edge.y * (across as f64 / ACROSS as f64 - 1.0))
    }

    /// A point of the body, in half elements around (clockwise cut first) and up from the bore.
    fn rim(&self, around: usize, up: usize) -> Point2<f64> {
        let top = self.top(around);
        let angle = top.y.atan2(top.x);
        let bottom = Point2::new(angle.cos(), angle.sin()) * self.bore;
        let part = up as f64 / (2 * DEPTH) as f64;
        bottom + (top - bottom) * part * (1.6 - 0.6 * part)
    }

    /// The upper side of the body: half a space, half a fillet, the foot of the tooth and back.
    fn top(&self, around: usize) -> Point2<f64> {
        if around > 2 * AROUND - around {
            let other = self.top(2 * AROUND - around);
            return Point2::new(other.x, -other.y);
        }
        let (profile, side) = (self.outline.profile(), 2 * (LOW + SPACE));
        let [from, to] = [profile.half_pitch(), profile.root_half_angle()];
        // Two fillets may leave no part of the root circle.
        let land = if from - to > 1e-3 * from { 2 * SPACE } else { 0 };
        if around < land {
            let angle = from + around as f64 / land as f64 * (to - from);
            let radius = profile.circles().root;
            return Point2::new(radius * angle.cos(), -radius * angle.sin());
        }
        if around <= side {
            let part = (around - land) as f64 / (side - land) as f64;
            let edge = self.outline.at(Piece::Fillet, 0.5 * part);
            return Point2::new(edge.x, -edge.y);
        }
        self.tooth(around - side, 0)
    }
}

fn grid(columns: usize, rows: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..rows).flat_map(move |row| (0..columns).map(move |column| (column, row)))
}

fn assembled(places: &[Point2<f64>], elements: &[[usize; 8]], poisson: f64) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(2 * places.len(), 2 * places.len());
    for nodes in elements {
        let stiffness = element(&nodes.map(|node| places[node]), poisson);
        for (row, column) in grid(16, 16) {
            let at = |entry: usize| 2 * nodes[entry / 2] + entry % 2;
            all[(at(row), at(column))] += stiffness[(row, column)];
        }
    }
    all
}

/// Stiffness of an eight-node element in plane strain with nine integration points.
fn element(places: &[Point2<f64>; 8], poisson: f64) -> SMatrix<f64, 16, 16> {
    let scale = 1.0 / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let (own, other, shear) = (1.0 - poisson, poisson, 0.5 - poisson);
    let material = Matrix3::new(own, other, 0.0, other, own, 0.0, 0.0, 0.0, shear) * scale;
    let far = 0.6f64.sqrt();
    let points = [(-far, 5.0 / 9.0), (0.0, 8.0 / 9.0), (far, 5.0 / 9.0)];
    let mut stiffness = SMatrix::<f64, 16, 16>::zeros();
    for (x, weight_x) in points {
        for (y, weight_y) in points {
            let slopes = slopes(x, y);
            let mut jacobian = nalgebra::Matrix2::zeros();
            for (slope, place) in slopes.iter().zip(places) {
                jacobian += slope * place.coords.transpose();
            }
            let determinant = jacobian.determinant();
            assert!(determinant > 0.0, "a folded element: {places:?}");
            let inverse = jacobian.try_inverse().expect("an area");
            let mut strain = SMatrix::<f64, 3, 16>::zeros();
            for (node, slope) in slopes.iter().enumerate() {
                let slope = inverse * slope;
                strain[(0, 2 * node)] = slope.x;
                strain[(1, 2 * node + 1)] = slope.y;
                strain[(2, 2 * node)] = slope.y;
                strain[(2, 2 * node + 1)] = slope.x;
            }
            stiffness +=
                strain.transpose() * material * strain * (determinant * weight_x * weight_y);
        }
    }
    stiffness
}

/// Derivatives of the eight shape functions.
fn slopes(x: f64, y: f64) -> [Vector2<f64>; 8] {
    let corner = |a: f64, b: f64| {
        Vector2::new(
            0.25 * a * (1.0 + b * y) * (2.0 * a * x + b * y),
            0.25 * b * (1.0 + a * x) * (a * x + 2.0 * b * y),
        )
    };
    let level = |b: f64| Vector2::new(-x * (1.0 + b * y), 0.5 * b * (1.0 - x * x));
    let upright = |a: f64| Vector2::new(0.5 * a * (1.0 - y * y), -y * (1.0 + a * x));
    [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
        level(-1.0),
        upright(1.0),
        level(1.0),
        upright(-1.0),
    ]
}
