//! Mapped nine-node elements on half a tooth, half a space and the rim below.

use nalgebra::Vector2;

use super::boundary::Boundary;
use super::grading::{FlankRows, Grading, ends, with_middles};

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
