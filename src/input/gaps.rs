//! Gaps in the lines of a drawing, and where they are bridged.
//!
//! A mask of ink -> [`Bridge`]s.
//!
//! 1. Distances from the ink (Felzenszwalb and Huttenlocher, through imageproc). Bare pixels are taken in the order of falling
//!    distance, and basins grow around the peaks, as in a watershed.
//! 2. Where two basins meet, at half the width of the passage between them: they are united if the passage is wider than a gap may
//!    be, or if the smaller basin is no more than a bay of it.
//! 3. Else the ink on both sides is looked at. A passage is a gap if a line *ends* there: seen from a small circle around its last
//!    pixel, ink leaves it in one direction only. Between two lines that pass one another (a hand near a hip) it is a passage, and stays open.
//! 4. Of the gaps, those between the outside and a basin that nothing else joins to it are bridged, straight from end to end.
//!
//! Cost O(#pixels log #pixels).

use image::{GrayImage, ImageBuffer, Luma};
use imageproc::distance_transform::euclidean_squared_distance_transform;
use rayon::prelude::*;

use crate::math::DisjointSets;

/// A basin counts as one of its own if it is this many times wider than the passage into it.
const LEAST_WIDENING: f32 = 1.5;
/// The most gaps, those within the figure and within the outside included.
const MOST_GAPS: usize = 256;
/// Rounding of distances to pixels.
const ROUNDING: f32 = 1.0;
/// Radius of the circle around the end of a line, in widths of the line.
const END_CIRCLE: f32 = 2.0;
/// Directions in which that circle is looked at.
const DIRECTIONS: usize = 48;
/// The cosine of the least angle between the ways to the ink on both sides of a passage: a right angle and some more.
const OPPOSITE: f32 = -0.3;

/// A gap: a straight line between two ends, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bridge {
    /// The centre of the last pixel of ink on one side.
    pub(super) from: [f32; 2],
    /// On the other.
    pub(super) to: [f32; 2],
}

impl Bridge {
    /// How wide the gap is.
    pub(super) fn length(&self) -> f32 {
        (self.to[0] - self.from[0]).hypot(self.to[1] - self.from[1])
    }

    /// How far a point is from it.
    pub(super) fn distance(&self, x: f32, y: f32) -> f32 {
        let (dx, dy) = (self.to[0] - self.from[0], self.to[1] - self.from[1]);
        let length = (dx * dx + dy * dy).max(f32::MIN_POSITIVE);
        let along = (((x - self.from[0]) * dx + (y - self.from[1]) * dy) / length).clamp(0.0, 1.0);
        (x - self.from[0] - along * dx).hypot(y - self.from[1] - along * dy)
    }
}

/// The basins around the peaks of distance.
struct Basins {
    sets: DisjointSets,
    /// Their largest distances.
    peak: Vec<f32>,
}

impl Basins {
    fn root(&mut self, basin: usize) -> usize {
        self.sets.root(basin)
    }

    fn unite(&mut self, a: usize, b: usize) {
        let [kept, gone] = self.sets.unite(a, b);
        self.peak[kept] = self.peak[kept].max(self.peak[gone]);
    }
}

/// The bare pixels of a mask of ink, by their distance from it.
pub(super) struct Bare<'a> {
    scene: Ink<'a>,
    /// A pixel's distance from the ink.
    distance: Vec<f32>,
    /// The pixels that are not ink, the farthest first.
    order: Vec<u32>,
}

impl<'a> Bare<'a> {
    /// Measures the pixels of `ink`, which is `width` pixels wide.
    pub(super) fn measure(ink: &'a [bool], width: usize) -> Self {
        let height = ink.len() / width.max(1);
        let scene = Ink { ink, width, height };
        if !ink.contains(&true) {
            return Self {
                scene,
                distance: Vec::new(),
                order: Vec::new(),
            };
        }
        // A drawing that touches the frame must not be seen as open there: the frame is as far away as it is.
        let picture: GrayImage = ImageBuffer::from_fn(width as u32, height as u32, |x, y| {
            Luma([u8::from(ink[y as usize * width + x as usize])])
        });
        let squared = euclidean_squared_distance_transform(&picture).into_raw();
        let mut order: Vec<(u32, u32)> = (0_u32..)
            .zip(&squared)
            .filter(|(_, squared)| **squared > 0.0)
            .map(|(at, squared)| (*squared as u32, at))
            .collect();
        // Squares are whole numbers.
        order.par_sort_unstable_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        Self {
            scene,
            distance: squared.iter().map(|squared| squared.sqrt() as f32).collect(),
            order: order.into_iter().map(|(_, at)| at).collect(),
        }
    }

    /// The gaps of at most `widest` pixels that let the outside into what lines of the given mean width enclose; the outside is where
    /// `seeds` are.
    pub(super) fn bridges(&self, widest: f32, line_width: f32, seeds: &[usize]) -> Vec<Bridge> {
        let Self { scene, distance, order } = self;
        if order.is_empty() {
            return Vec::new();
        }
        const NONE: usize = usize::MAX;
        let mut basin_of = vec![NONE; distance.len()];
        let mut basins = Basins {
            sets: DisjointSets::new(0),
            peak: Vec::new(),
        };
        let mut gaps: Vec<(Bridge, usize, usize)> = Vec::new();
        let mut beside: Vec<usize> = Vec::new();
        for at in order.iter().map(|at| *at as usize) {
            let own = distance[at];
            beside.clear();
            scene.for_each_neighbour(at, |other| {
                if basin_of[other] != NONE {
                    let root = basins.root(basin_of[other]);
                    if !beside.contains(&root) {
                        beside.push(root);
                    }
                }
            });
            let Some((&first, rest)) = beside.split_first() else {
                basin_of[at] = basins.sets.add();
                basins.peak.push(own);
                continue;
            };
            basin_of[at] = first;
            for &other in rest {
                let (a, b) = (basins.root(first), basins.root(other));
                if a == b {
                    continue;
                }
                let narrower = basins.peak[a].min(basins.peak[b]);
                let is_bay = narrower < LEAST_WIDENING * own + ROUNDING;
                if is_bay || 2.0 * own - ROUNDING > widest {
                    basins.unite(a, b);
                    continue;
                }
                let known = gaps.iter().any(|(bridge, c, d)| {
                    let pair = [basins.root(*c), basins.root(*d)];
                    let (x, y) = scene.place(at);
                    pair.contains(&a) && pair.contains(&b) && bridge.distance(x, y) <= bridge.length() + line_width
                });
                if known {
                    // The dam of a gap that was found higher up.
                    basin_of[at] = NONE;
                    break;
                }
                if gaps.len() == MOST_GAPS {
                    // This is no drawing in lines.
                    return Vec::new();
                }
                match scene.gap_at(at, own, line_width) {
                    Some(bridge) => {
                        gaps.push((bridge, a, b));
                        basin_of[at] = NONE;
                        break;
                    }
                    None => basins.unite(a, b),
                }
            }
        }
        let outside: Vec<usize> = seeds
            .iter()
            .filter(|&&seed| basin_of[seed] != NONE)
            .map(|&seed| basins.root(basin_of[seed]))
            .collect();
        gaps.into_iter()
            .filter_map(|(bridge, a, b)| {
                let is_outside = [a, b].map(|basin| outside.contains(&basins.root(basin)));
                (is_outside[0] != is_outside[1]).then_some(bridge)
            })
            .collect()
    }
}

struct Ink<'a> {
    ink: &'a [bool],
    width: usize,
    height: usize,
}

impl Ink<'_> {
    fn place(&self, at: usize) -> (f32, f32) {
        ((at % self.width) as f32, (at / self.width) as f32)
    }

    fn for_each_neighbour(&self, at: usize, mut found: impl FnMut(usize)) {
        let (x, y) = (at % self.width, at / self.width);
        for row in y.saturating_sub(1)..(y + 2).min(self.height) {
            for column in x.saturating_sub(1)..(x + 2).min(self.width) {
                if (column, row) != (x, y) {
                    found(row * self.width + column);
                }
            }
        }
    }

    /// Ink within `radius` of a place, with how far it is, the nearest first.
    fn around(&self, (x, y): (f32, f32), radius: f32) -> Vec<(f32, usize)> {
        let low = |c: f32| (c - radius).floor().max(0.0) as usize;
        let mut found = Vec::new();
        for row in low(y)..((y + radius).ceil() as usize + 1).min(self.height) {
            for column in low(x)..((x + radius).ceil() as usize + 1).min(self.width) {
                let at = row * self.width + column;
                let far = (column as f32 - x).hypot(row as f32 - y);
                if self.ink[at] && far <= radius {
                    found.push((far, at));
                }
            }
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found
    }

    /// The gap whose middle is at `at`, `half` its width away from the ink, if it is one.
    fn gap_at(&self, at: usize, half: f32, line_width: f32) -> Option<Bridge> {
        let (x, y) = self.place(at);
        let near = self.around((x, y), 1.5 * half + 2.0);
        let (_, from) = *near.first()?;
        let (from_x, from_y) = self.place(from);
        let first = (from_x - x, from_y - y);
        let opposite = near.iter().find(|(far, other)| {
            let (other_x, other_y) = self.place(*other);
            let way = (other_x - x, other_y - y);
            way.0 * first.0 + way.1 * first.1 <= OPPOSITE * far * first.0.hypot(first.1)
        });
        let (_, to) = *opposite?;
        let radius = END_CIRCLE * line_width + 2.0;
        (self.ends(from, radius) || self.ends(to, radius)).then(|| {
            let (to_x, to_y) = self.place(to);
            Bridge {
                from: [from_x, from_y],
                to: [to_x, to_y],
            }
        })
    }

    /// Whether a line ends at a pixel of ink: from the circle around it, what hangs together with it is seen in one direction only.
    fn ends(&self, at: usize, radius: f32) -> bool {
        let (x, y) = self.place(at);
        let mut hanging = vec![at];
        let mut next = 0;
        while next < hanging.len() {
            let from = hanging[next];
            next += 1;
            self.for_each_neighbour(from, |other| {
                let (other_x, other_y) = self.place(other);
                if self.ink[other] && (other_x - x).hypot(other_y - y) <= radius + 1.5 && !hanging.contains(&other) {
                    hanging.push(other);
                }
            });
        }
        let seen: Vec<bool> = (0..DIRECTIONS)
            .map(|k| {
                let angle_rad = std::f32::consts::TAU * k as f32 / DIRECTIONS as f32;
                // The angle only chooses pixels to look at.
                let (sine, cosine) = (libm::sinf(angle_rad), libm::cosf(angle_rad));
                let (column, row) = ((x + radius * cosine).round(), (y + radius * sine).round());
                column >= 0.0
                    && row >= 0.0
                    && (column as usize) < self.width
                    && hanging.contains(&(row as usize * self.width + column as usize))
            })
            .collect();
        let runs = (0..DIRECTIONS)
            .filter(|&k| seen[k] && !seen[(k + 1) % DIRECTIONS])
            .count();
        // All around is a blot, nothing a speck: neither is the end of a line.
        runs == 1
    }
}
