//! Mapped nine-node elements on half a tooth, half a space and the rim below.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use nalgebra::Vector2;

use super::{FieldInput, FieldRefusal};
use crate::model::profile::Profile;
use crate::numeric::steps;

/// Nodes of an element: three from the centre line to the space, times three from the bore upwards.
/// The second index runs faster.
pub(super) type Nodes = [usize; 9];

/// The mesh; lengths in modules.
///
/// The numbers of the nodes run from the tip to the rim, then down the columns of the rim from the
/// centre line. The nodes of the cut in the middle of the space follow. The clamped nodes on the
/// bore are last.
#[derive(Debug, Clone)]
pub(super) struct Mesh {
    /// Places of the nodes: x across the tooth, y along its centre line.
    pub(super) places: Vec<Vector2<f64>>,
    /// The elements.
    pub(super) elements: Vec<Nodes>,
    /// The loads, from the tip to the junction.
    pub(super) loads: Vec<LoadPlace>,
    layout: Layout,
}

/// A node of the flank on which an elliptical patch is centred.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LoadPlace {
    /// Roll angle, in rad.
    pub(super) roll: f64,
    /// Heights of the rows above and below the node.
    pub(super) heights: [f64; 2],
    /// The nodes of both rows on the flank, from above.
    pub(super) nodes: [usize; 5],
}

/// Counts of nodes and their numbers.
#[derive(Debug, Clone, Copy)]
struct Layout {
    /// Rows of nodes of the tooth block, including the row shared with the rim.
    tooth_rows: usize,
    /// Nodes in each row of the tooth block.
    tooth_columns: usize,
    /// Columns of nodes of the rim.
    rim_columns: usize,
    /// Rows of nodes of the rim, without those on the bore.
    rim_rows: usize,
}

impl Layout {
    /// The node of the tooth block, rows counted from the tip.
    fn tooth(&self, column: usize, row: usize) -> usize {
        if row + 1 < self.tooth_rows {
            row * self.tooth_columns + column
        } else {
            self.rim(column, 0)
        }
    }

    /// The node of the rim, rows counted from the top.
    fn rim(&self, column: usize, row: usize) -> usize {
        let first = (self.tooth_rows - 1) * self.tooth_columns;
        if row < self.rim_rows {
            first + column * self.rim_rows + row
        } else {
            first + self.rim_columns * self.rim_rows + column
        }
    }
}

/// Arc lengths and relative depths of the rows and columns of nodes.
struct Lines {
    /// Arc lengths of the rows of nodes of the tooth block on the boundary.
    arcs: Vec<f64>,
    /// Shares of the half thickness at the columns of nodes.
    shares: Vec<f64>,
    /// Arc lengths of the columns of nodes beside the tooth block.
    space: Vec<f64>,
    /// Shares of the depth at the rows of nodes of the rim.
    depths: Vec<f64>,
}

impl Mesh {
    /// The mesh between the boundary and a bore of the given radius.
    pub(super) fn of(boundary: &Boundary, bore: f64, grading: &Grading) -> Mesh {
        let flank = grading.flank_rows(boundary.flank_length);
        let lines = Lines::of(boundary, bore, grading, &flank);
        let layout = Layout {
            tooth_rows: lines.arcs.len(),
            tooth_columns: lines.shares.len(),
            rim_columns: lines.shares.len() + lines.space.len(),
            rim_rows: lines.depths.len() - 1,
        };
        let count = layout.rim(layout.rim_columns - 1, layout.rim_rows) + 1;
        let mut places = vec![Vector2::zeros(); count];
        place_tooth(&mut places, &layout, boundary, bore, &lines);
        place_rim(&mut places, &layout, boundary, bore, &lines);
        let loads = flank
            .loads
            .iter()
            .map(|&row| load_place(boundary, &layout, &lines.arcs, row))
            .collect();
        Mesh { places, elements: elements(&layout), loads, layout }
    }

    /// Load places between all rows of the involute: every second place is a load of the field.
    #[cfg(test)]
    pub(super) fn all_load_places(
        &self,
        boundary: &Boundary,
        bore: f64,
        grading: &Grading,
    ) -> Vec<LoadPlace> {
        let flank = grading.flank_rows(boundary.flank_length);
        let lines = Lines::of(boundary, bore, grading, &flank);
        let place = |row| load_place(boundary, &self.layout, &lines.arcs, row);
        (0..flank.heights.len() - 1).map(place).collect()
    }

    /// Number of nodes off the cut and off the bore.
    pub(super) fn inner(&self) -> usize {
        self.layout.rim(self.layout.rim_columns - 1, 0)
    }

    /// Number of nodes on the cut.
    pub(super) fn on_cut(&self) -> usize {
        self.layout.rim_rows
    }

    /// Whether the node is on the centre line.
    pub(super) fn is_central(&self, node: usize) -> bool {
        self.places[node].x == 0.0
    }

    /// The edges of the elements on the centre line, from the tip down, as nodes.
    pub(super) fn centre_edges(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        let layout = self.layout;
        let tooth = (0..layout.tooth_rows - 1)
            .step_by(2)
            .map(move |row| [0, 1, 2].map(|step| layout.tooth(0, row + step)));
        let rim = (0..layout.rim_rows)
            .step_by(2)
            .map(move |row| [0, 1, 2].map(|step| layout.rim(0, row + step)));
        tooth.chain(rim)
    }
}

impl Lines {
    fn of(boundary: &Boundary, bore: f64, grading: &Grading, flank: &FlankRows) -> Lines {
        let above = flank.heights[flank.heights.len() - 1];
        let mut heights = flank.heights.clone();
        heights.extend(grading.fillet_rows(boundary.turned_length, above));
        let last = boundary.flank_length + boundary.turned_length;
        let step = (boundary.length() - last) / (2 * grading.space_columns) as f64;
        Lines {
            arcs: with_middles(&ends(&heights)),
            shares: with_middles(&grading.column_ends()),
            space: (1..=2 * grading.space_columns)
                .map(|column| last + step * column as f64)
                .collect(),
            depths: with_middles(&grading.rim_ends(boundary.root, bore)),
        }
    }
}

/// Places the tooth block: parabolas across the tooth, an arc at the tip.
fn place_tooth(
    places: &mut [Vector2<f64>],
    layout: &Layout,
    boundary: &Boundary,
    bore: f64,
    lines: &Lines,
) {
    /// Sag of the lowest row relative to its half width, and least remaining part of the depth.
    const SAG: (f64, f64) = (0.13, 0.6);
    let corner = boundary.at(0.0);
    let lowest = boundary.at(lines.arcs[layout.tooth_rows - 1]);
    let lowest_centre = (lowest.y - SAG.0 * lowest.x).max(bore + SAG.1 * (lowest.norm() - bore));
    for (row, &arc) in lines.arcs.iter().enumerate() {
        let side = boundary.at(arc);
        let part = (corner.y - side.y) / (corner.y - lowest.y);
        let centre = boundary.tip + part * (lowest_centre - boundary.tip);
        for (column, &share) in lines.shares.iter().enumerate() {
            let x = share * side.x;
            let y = if row == 0 {
                ((boundary.tip - x) * (boundary.tip + x)).sqrt()
            } else {
                centre + (side.y - centre) * share * share
            };
            places[layout.tooth(column, row)] = Vector2::new(x, y);
        }
    }
}

/// Places the rim below the tooth block and the space, down to the bore.
fn place_rim(
    places: &mut [Vector2<f64>],
    layout: &Layout,
    boundary: &Boundary,
    bore: f64,
    lines: &Lines,
) {
    /// Depth, in modules, in which the columns change to equal angles.
    const SPREAD: f64 = 1.5;
    /// Thickness of the rim, in modules, up to which its columns stay straight.
    const THIN: f64 = 0.3;
    let thickness = boundary.root - bore;
    let evenness = -(-thickness / THIN).exp_m1();
    let spread = |depth: f64| (-depth * thickness / SPREAD).exp_m1();
    let last = layout.rim_columns - 1;
    for column in 0..=last {
        let top = match lines.space.get(column.wrapping_sub(layout.tooth_columns)) {
            Some(&arc) => boundary.at(arc),
            None => places[layout.tooth(column, layout.tooth_rows - 1)],
        };
        let (radius, angle) = if column == last {
            (boundary.root, boundary.half_pitch)
        } else {
            (top.norm(), top.x.atan2(top.y))
        };
        let equal_angle = boundary.half_pitch * column as f64 / last as f64;
        let bottom_angle = angle + evenness * (equal_angle - angle);
        for (row, &depth) in lines.depths.iter().enumerate() {
            let here = angle + (bottom_angle - angle) * spread(depth) / spread(1.0);
            let place = Vector2::new(here.sin(), here.cos());
            places[layout.rim(column, row)] = place * (radius + depth * (bore - radius));
        }
    }
}

/// The load on the flank below a row of elements.
fn load_place(boundary: &Boundary, layout: &Layout, arcs: &[f64], row: usize) -> LoadPlace {
    let middle = 2 * row + 2;
    LoadPlace {
        roll: boundary.roll(arcs[middle]),
        heights: [arcs[middle] - arcs[middle - 2], arcs[middle + 2] - arcs[middle]],
        nodes: [0, 1, 2, 3, 4]
            .map(|step| layout.tooth(layout.tooth_columns - 1, middle - 2 + step)),
    }
}

/// The elements of tooth block and rim.
fn elements(layout: &Layout) -> Vec<Nodes> {
    let block = |columns: usize, rows: usize, node: &dyn Fn(usize, usize) -> usize| {
        let corners = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        corners
            .map(|(column, row)| {
                std::array::from_fn(|index| node(2 * column + index / 3, 2 * row + 2 - index % 3))
            })
            .collect::<Vec<_>>()
    };
    let mut all = block(layout.tooth_columns / 2, layout.tooth_rows / 2, &|column, row| {
        layout.tooth(column, row)
    });
    all.extend(block(layout.rim_columns / 2, layout.rim_rows / 2, &|column, row| {
        layout.rim(column, row)
    }));
    all
}

/// Number of intervals in the table of the fillet.
const FILLET_STEPS: usize = 128;
/// Least length of the loaded involute, in modules.
const LEAST_FLANK: f64 = 0.15;
/// Least thickness of the tooth at its tip and at its neck, in modules.
const LEAST_THICKNESS: f64 = 0.004;

/// Rounding tolerance of half a space's angle at the root circle, in rad.
const LEAST_ANGLE: f64 = 1e-12;

/// The boundary in modules: x across the tooth from its centre line, y along it from the gear's
/// centre.
#[derive(Debug, Clone)]
pub(super) struct Boundary {
    profile: Profile,
    module: f64,
    /// Radius of the base circle.
    pub(super) base: f64,
    /// Radius of the root circle.
    pub(super) root: f64,
    /// Radius of the tip circle.
    pub(super) tip: f64,
    /// Half of the pitch angle, in rad.
    pub(super) half_pitch: f64,
    /// Roll angle at the tip, in rad.
    pub(super) tip_roll: f64,
    /// Roll angle at the junction of involute and fillet, in rad.
    pub(super) junction_roll: f64,
    /// Length of the involute.
    flank_length: f64,
    /// Arc length of the fillet from the junction, and the angle of the rack's normal there.
    fillet: Vec<(f64, f64)>,
    /// Length from the junction down to the point where the fillet has turned by 45 degrees.
    turned_length: f64,
    /// Half of the tooth's angle at the root circle, in rad.
    root_half_angle: f64,
}

impl Boundary {
    /// The boundary of the gear's teeth.
    ///
    /// # Errors
    /// A [`FieldRefusal`] if the tooth is pointed, cut through, or has nearly no involute.
    pub(super) fn of(input: &FieldInput) -> Result<Boundary, FieldRefusal> {
        let (profile, module) = (input.profile, input.module);
        let circles = profile.circles();
        let base = circles.base / module;
        let (tip_roll, junction_roll) =
            (circles.tip_curvature / circles.base, profile.junction.roll);
        let flank_length = base * (tip_roll - junction_roll) * (tip_roll + junction_roll) / 2.0;
        let mut boundary = Boundary {
            profile,
            module,
            base,
            root: circles.root / module,
            tip: circles.tip / module,
            half_pitch: profile.half_pitch(),
            tip_roll,
            junction_roll,
            flank_length,
            fillet: Vec::new(),
            turned_length: 0.0,
            root_half_angle: profile.root_half_angle(),
        };
        if flank_length.is_nan() || flank_length < LEAST_FLANK {
            return Err(FieldRefusal::ShortFlank {
                length: flank_length * module,
                least: LEAST_FLANK * module,
            });
        }
        let space = boundary.half_pitch - boundary.root_half_angle;
        if space.is_nan() || space < -LEAST_ANGLE {
            return Err(FieldRefusal::NoSpace { width: 2.0 * space * circles.root });
        }
        boundary.walk_fillet()?;
        boundary.check_tip()?;
        Ok(boundary)
    }

    /// Length of the boundary from the tip's corner to the middle of the space.
    pub(super) fn length(&self) -> f64 {
        self.root_start() + self.root * (self.half_pitch - self.root_half_angle)
    }

    /// Length of the fillet.
    fn fillet_length(&self) -> f64 {
        self.fillet.last().map_or(0.0, |end| end.0)
    }

    /// Roll angle of the involute at an arc length from the tip, in rad.
    pub(super) fn roll(&self, arc: f64) -> f64 {
        let squared = self.tip_roll * self.tip_roll - 2.0 * arc / self.base;
        squared.max(0.0).sqrt().max(self.junction_roll)
    }

    /// Angle between the force on the flank and the normal of the centre line, in rad.
    pub(super) fn load_angle(&self, roll: f64) -> f64 {
        self.profile.load_angle(roll)
    }

    /// The boundary at an arc length from the tip's corner.
    pub(super) fn at(&self, arc: f64) -> Vector2<f64> {
        if arc <= self.flank_length {
            let section = self.profile.involute_at(self.roll(arc));
            Vector2::new(section.half_thickness, section.along) / self.module
        } else if arc < self.root_start() {
            self.fillet_point(self.normal(arc - self.flank_length))
        } else {
            let angle = self.root_half_angle + (arc - self.root_start()) / self.root;
            Vector2::new(angle.sin(), angle.cos()) * self.root
        }
    }

    fn root_start(&self) -> f64 {
        self.flank_length + self.fillet_length()
    }

    fn fillet_point(&self, normal: f64) -> Vector2<f64> {
        let section = self.profile.fillet_at(normal);
        Vector2::new(section.half_thickness, section.along) / self.module
    }

    /// Angle of the rack's normal at an arc length of the fillet, in rad.
    fn normal(&self, arc: f64) -> f64 {
        let next = self.fillet.partition_point(|entry| entry.0 < arc);
        let (to, from) = (next.clamp(1, FILLET_STEPS), next.clamp(1, FILLET_STEPS) - 1);
        let ((low, start), (high, end)) = (self.fillet[from], self.fillet[to]);
        start + (end - start) * (arc - low) / (high - low)
    }

    /// Fills the table of the fillet and finds the point where it has turned by 45 degrees.
    fn walk_fillet(&mut self) -> Result<(), FieldRefusal> {
        const TURNED: (f64, f64) = (0.15, 0.9);
        let first = self.profile.junction.normal;
        let (mut arc, mut turned, mut neck) = (0.0, None, f64::INFINITY);
        let mut last: Option<Vector2<f64>> = None;
        for normal in steps(first, FRAC_PI_2, FILLET_STEPS) {
            let point = self.fillet_point(normal);
            let chord = last.map_or(-Vector2::y(), |last| point - last);
            if turned.is_none() && chord.x.atan2(-chord.y) >= FRAC_PI_4 {
                turned = Some(arc);
            }
            arc += last.map_or(0.0, |_| chord.norm());
            neck = neck.min(point.x);
            self.fillet.push((arc, normal));
            last = Some(point);
        }
        self.turned_length = turned.unwrap_or(arc).clamp(TURNED.0 * arc, TURNED.1 * arc);
        if neck.is_nan() || 2.0 * neck < LEAST_THICKNESS {
            return Err(FieldRefusal::CutThrough {
                thickness: 2.0 * neck * self.module,
                least: LEAST_THICKNESS * self.module,
            });
        }
        Ok(())
    }

    fn check_tip(&self) -> Result<(), FieldRefusal> {
        let thickness = self.profile.tip_thickness();
        let least = LEAST_THICKNESS * self.module;
        if thickness.is_nan() || thickness < least {
            return Err(FieldRefusal::PointedTip { thickness, least });
        }
        Ok(())
    }
}

/// Sizes of the elements; lengths in modules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grading {
    /// Elements from the centre line of the tooth to its flank.
    pub(super) columns: usize,
    /// Ratio of the widths of neighbouring columns, the finest at the flank.
    column_ratio: f64,
    /// Elements along the boundary from the tooth block to the middle of the space.
    space_columns: usize,
    /// Height of the two rows below the tip's corner.
    tip_row: f64,
    /// Height of the row above the junction of involute and fillet.
    junction_row: f64,
    /// Ratio of the heights of neighbouring rows, or pairs of rows.
    growth: f64,
    /// Greatest height of a row on the involute.
    flank_limit: f64,
    /// Greatest height of a row on the fillet.
    fillet_limit: f64,
    /// Height of the first row of the rim.
    rim_row: f64,
    /// Greatest height of a row of the rim, over the radius there.
    rim_share: f64,
}

/// Heights of the rows on the involute, from the tip down, in modules.
#[derive(Debug, Clone, PartialEq)]
struct FlankRows {
    /// Heights of the rows.
    pub(super) heights: Vec<f64>,
    /// Numbers of the rows that end at a load.
    pub(super) loads: Vec<usize>,
}

impl Grading {
    /// The mesh of every field.
    pub(super) const STANDARD: Grading = Grading {
        columns: 6,
        column_ratio: 1.6,
        space_columns: 2,
        tip_row: 0.02,
        junction_row: 0.05,
        growth: 1.5,
        flank_limit: 0.15,
        fillet_limit: 0.3,
        rim_row: 0.2,
        rim_share: 0.15,
    };

    /// Half of every size.
    #[cfg(test)]
    pub(super) fn halved(self) -> Grading {
        Grading {
            columns: 2 * self.columns,
            column_ratio: self.column_ratio.sqrt(),
            space_columns: 2 * self.space_columns,
            tip_row: self.tip_row / 2.0,
            junction_row: self.junction_row / 2.0,
            growth: self.growth.sqrt(),
            flank_limit: self.flank_limit / 2.0,
            fillet_limit: self.fillet_limit / 2.0,
            rim_row: self.rim_row / 2.0,
            rim_share: self.rim_share / 2.0,
        }
    }

    /// Twice as many loads between the outermost loads.
    #[cfg(test)]
    pub(super) fn with_more_loads(self) -> Grading {
        Grading { growth: self.growth.sqrt(), flank_limit: self.flank_limit / 2.0, ..self }
    }

    /// Twice every size.
    #[cfg(test)]
    pub(super) fn doubled(self) -> Grading {
        Grading {
            columns: self.columns / 2,
            column_ratio: self.column_ratio.powi(2),
            space_columns: self.space_columns / 2,
            tip_row: self.tip_row * 2.0,
            junction_row: self.junction_row * 2.0,
            growth: self.growth.powi(2),
            flank_limit: self.flank_limit * 2.0,
            fillet_limit: self.fillet_limit * 2.0,
            rim_row: self.rim_row * 2.0,
            rim_share: self.rim_share * 2.0,
        }
    }

    /// Ends of the columns over the half thickness, from 0 at the centre line to 1 at the flank.
    fn column_ends(&self) -> Vec<f64> {
        let narrower = |width: &f64| Some(width / self.column_ratio);
        let widths: Vec<_> =
            std::iter::successors(Some(1.0), narrower).take(self.columns).collect();
        ends(&scaled(&widths, 1.0))
    }

    /// Rows of an involute of the given length: pairs of equal rows with a load between them, and a
    /// single row above the junction with the last load.
    fn flank_rows(&self, length: f64) -> FlankRows {
        let (mut upper, mut lower) = (vec![self.tip_row], Vec::new());
        let mut lowest = self.junction_row;
        let mut filled = 2.0 * self.tip_row + self.junction_row;
        while filled < length {
            let highest = upper[upper.len() - 1];
            let next = (highest.min(lowest) * self.growth).min(self.flank_limit);
            if highest < lowest {
                upper.push(next);
            } else {
                lower.push(next);
                lowest = next;
            }
            filled += 2.0 * next;
        }
        let rest = filled - 2.0 * self.tip_row;
        let scale = (length - 2.0 * self.tip_row) / rest;
        let mut heights = vec![self.tip_row; 2];
        for height in upper[1..].iter().chain(lower.iter().rev()) {
            heights.extend([height * scale; 2]);
        }
        heights.push(self.junction_row * scale);
        let loads = (0..heights.len()).step_by(2).collect();
        FlankRows { heights, loads }
    }

    /// Heights of the rows of a fillet of the given length, from the junction down. The first row
    /// is as high as the row above the junction.
    fn fillet_rows(&self, length: f64, first: f64) -> Vec<f64> {
        let first = first.min(length / 2.0);
        let mut heights = Vec::new();
        let (mut filled, mut height) = (first, first);
        while heights.is_empty() || filled < length {
            height = (height * self.growth).min(self.fillet_limit);
            filled += height;
            heights.push(height);
        }
        let mut rows = vec![first];
        rows.extend(scaled(&heights, length - first));
        rows
    }

    /// Ends of the rows of the rim over its thickness, from 0 at the root circle to 1 at the bore.
    fn rim_ends(&self, root: f64, bore: f64) -> Vec<f64> {
        const LEAST_ROWS: usize = 3;
        let mut heights = Vec::new();
        let (mut radius, mut height) = (root, self.rim_row);
        while radius > bore || heights.len() < LEAST_ROWS {
            heights.push(height);
            radius -= height;
            height = (height * self.growth).min(self.rim_share * radius.max(bore));
        }
        ends(&scaled(&heights, 1.0))
    }
}

/// The sizes, scaled to a sum.
fn scaled(sizes: &[f64], sum: f64) -> Vec<f64> {
    let scale = sum / sizes.iter().sum::<f64>();
    sizes.iter().map(|size| size * scale).collect()
}

/// The end of each size, summed from 0.
pub(super) fn ends(sizes: &[f64]) -> Vec<f64> {
    let summed = sizes.iter().scan(0.0, |sum, size| {
        *sum += size;
        Some(*sum)
    });
    std::iter::once(0.0).chain(summed).collect()
}

/// The ends and their midpoints.
fn with_middles(ends: &[f64]) -> Vec<f64> {
    let halves = ends.windows(2).flat_map(|pair| [f64::midpoint(pair[0], pair[1]), pair[1]]);
    ends.first().copied().into_iter().chain(halves).collect()
}
