//! Sizes of the elements along each direction of the mesh.

/// Sizes of the elements; lengths in modules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grading {
    /// Elements from the centre line of the tooth to its flank.
    pub(super) columns: usize,
    /// Ratio of the widths of neighbouring columns, the finest at the flank.
    pub(super) column_ratio: f64,
    /// Elements along the boundary from the tooth block to the middle of the space.
    pub(super) space_columns: usize,
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
pub(super) struct FlankRows {
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
    pub(super) fn column_ends(&self) -> Vec<f64> {
        let narrower = |width: &f64| Some(width / self.column_ratio);
        let widths: Vec<_> =
            std::iter::successors(Some(1.0), narrower).take(self.columns).collect();
        ends(&scaled(&widths, 1.0))
    }

    /// Rows of an involute of the given length: pairs of equal rows with a load between them, and a
    /// single row above the junction with the last load.
    pub(super) fn flank_rows(&self, length: f64) -> FlankRows {
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
    pub(super) fn fillet_rows(&self, length: f64, first: f64) -> Vec<f64> {
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
    pub(super) fn rim_ends(&self, root: f64, bore: f64) -> Vec<f64> {
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
pub(super) fn with_middles(ends: &[f64]) -> Vec<f64> {
    let halves = ends.windows(2).flat_map(|pair| [f64::midpoint(pair[0], pair[1]), pair[1]]);
    ends.first().copied().into_iter().chain(halves).collect()
}
