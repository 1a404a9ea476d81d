//! The figures of the guide, each an SVG document that the guide's pages include: `cargo run --release --example figures --
//! src/guide/figures` draws them again. All but their frames and colours is what the library computes.
//!
//! A page of documentation is Markdown: a document begins with its opening tag on a line of its own and has no empty line, or its rest
//! would be read as text. It has no id, which could be another figure's, too.

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use inbetween::blend::{BlendOptions, RigidBlend};
use inbetween::math::{Point, point};
use inbetween::outline::{ArcLength, Ring};
use inbetween::pipeline::{ArtChoice, map_layer};
use inbetween::pose::Mapping;
use inbetween::render::Frame;
use inbetween::scene::{Scene, ShapeModel, ShapeScene};
use inbetween::weights::{RbfOptions, RbfWeights, WeightProvider};

#[path = "common/palette.rs"]
mod palette;

use palette::png_with_palette;

type Drawn = Result<(), Box<dyn Error>>;

/// Columns and rows of one of several pictures side by side.
const CELL: [f64; 2] = [140.0, 150.0];
/// The share of a cell that its picture takes at most.
const FILLED: f64 = 0.88;
/// The most bytes of a figure: it is part of a page.
const MOST_BYTES: usize = 60_000;

fn main() -> Drawn {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: figures FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let figures = [
        ("parts", "Three figures, their loose parts coloured", parts()?),
        (
            "matched",
            "Five outlines, corresponding points in equal colours",
            matched()?,
        ),
        (
            "weights",
            "Five maps of the pose space with lines of equal weight",
            weights()?,
        ),
        (
            "rigid-blend",
            "A snake in five steps, shrinking above, bending below",
            rigid_blend()?,
        ),
        (
            "curves",
            "A face in three steps, cross-faded above, morphed below",
            curves()?,
        ),
        (
            "cardinal-basis",
            "Three weights over a line, and their blend",
            cardinal_basis()?,
        ),
        (
            "contact-sheet",
            "A blob in five columns of bend and five rows of thickness",
            contact_sheet()?,
        ),
    ];
    for (name, label, figure) in figures {
        figure.save(&folder, name, label)?;
    }
    Ok(())
}

fn data(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    folder.join(name).join("scene.toml")
}

fn mapped(name: &str) -> Result<(Scene, Mapping), Box<dyn Error>> {
    let scene = Scene::open(&data(name))?;
    let (mapping, _) = map_layer(&scene.layer_spec(0)?)?;
    Ok((scene, mapping))
}

/// The pieces of the wizard's drawings: the body grey, every loose part in a colour.
fn parts() -> Result<Figure, Box<dyn Error>> {
    let scene = Scene::open(&data("wizard"))?;
    let mut figure = Figure::new([scene.poses.len(), 1], CELL);
    for pose in 0..scene.poses.len() {
        let drawing = scene.read_drawing(0, pose)?.drawing;
        let pieces: Vec<&Ring> = drawing.parts.iter().map(|part| part.outline.outer()).collect();
        let all: Vec<Point> = pieces.iter().flat_map(|ring| ring.points()).copied().collect();
        let fit = Fit::new([pose, 0], CELL, &all);
        let body = drawing.outline.outer();
        for (k, ring) in pieces.iter().enumerate() {
            let colour = if *ring == body {
                "#c8ccd4".to_owned()
            } else {
                hue(k as f64 / pieces.len() as f64)
            };
            figure.area(&fit.places(ring.points(), 1.0), &colour);
        }
    }
    Ok(figure)
}

/// The walker's outlines: what corresponds has one colour.
fn matched() -> Result<Figure, Box<dyn Error>> {
    const PIECES: usize = 36;
    const POINTS_A_PIECE: usize = 12;
    let (_, mapping) = mapped("walker")?;
    let matching = &mapping.matching;
    let mut figure = Figure::new([mapping.outlines.len(), 1], CELL);
    for (pose, outline) in mapping.outlines.iter().enumerate() {
        let fit = Fit::new([pose, 0], CELL, outline.outer().points());
        let curve = ArcLength::new(outline.outer());
        let at = |k: usize| {
            let share = k as f64 / (PIECES * POINTS_A_PIECE) as f64;
            let own = matching.outer.carry(matching.reference, pose, share.rem_euclid(1.0));
            curve.at(own)
        };
        let all: Vec<Point> = (0..PIECES * POINTS_A_PIECE).map(at).collect();
        figure.area(&fit.places(&all, 0.8), "#eceef2");
        for piece in 0..PIECES {
            let start = piece * POINTS_A_PIECE;
            let points: Vec<Point> = (start..=start + POINTS_A_PIECE).map(at).collect();
            figure.line(&fit.places(&points, 0.0), &hue(piece as f64 / PIECES as f64), 3.0);
        }
    }
    Ok(figure)
}

/// The weight of each of the walker's poses over the pose space: a line a tenth, the thick one a half.
fn weights() -> Result<Figure, Box<dyn Error>> {
    const STEPS: usize = 40;
    const REACH: f64 = 1.6;
    let scene = Scene::open(&data("walker"))?;
    let provider = scene.weights(None)?;
    let places: Vec<Point> = scene.places().iter().map(|at| Point::new(at[0], at[1])).collect();
    let mut figure = Figure::new([places.len(), 1], CELL);
    let node = |k: usize| REACH * (2.0 * k as f64 / STEPS as f64 - 1.0);
    // As in the explorer, the second coordinate grows upwards.
    let upright = |p: Point| Point::new(p.x, -p.y);
    for pose in 0..places.len() {
        let fit = Fit::new([pose, 0], CELL, &[Point::new(-REACH, -REACH), Point::new(REACH, REACH)]);
        let mut values = Vec::new();
        for row in 0..=STEPS {
            for column in 0..=STEPS {
                values.push(provider.weights_at(&[node(column), node(row)])?[pose]);
            }
        }
        for tenth in 1..10 {
            let lines = level_lines(&values, STEPS + 1, f64::from(tenth) / 10.0);
            for line in lines {
                let place = |p: &Point| (p / STEPS as f64 * 2.0 - Point::new(1.0, 1.0)) * REACH;
                let points: Vec<Point> = line.iter().map(|p| upright(place(p))).collect();
                let width = if tenth == 5 { 2.0 } else { 0.8 };
                figure.line(
                    &fit.places(&points, 0.4),
                    &hue(pose as f64 / places.len() as f64),
                    width,
                );
            }
        }
        for (other, place) in places.iter().enumerate() {
            figure.dot(fit.place(upright(*place)), if other == pose { 5.0 } else { 2.5 });
        }
    }
    Ok(figure)
}

/// The lines where values on a grid are `level`, in steps of the grid: pieces across its triangles, joined where they meet.
fn level_lines(values: &[f64], side: usize, level: f64) -> Vec<Vec<Point>> {
    let node = |k: usize| Point::new((k % side) as f64, (k / side) as f64);
    let crossing = |[a, b]: [usize; 2]| {
        let share = (level - values[a]) / (values[b] - values[a]);
        node(a) + (node(b) - node(a)) * share
    };
    let mut pieces: Vec<[[usize; 2]; 2]> = Vec::new();
    for corner in (0..values.len() - side).filter(|k| k % side + 1 < side) {
        let [right, below, across] = [corner + 1, corner + side, corner + side + 1];
        for [a, b, c] in [[corner, right, across], [corner, below, across]] {
            let crossed = [[a, b], [b, c], [a, c]]
                .into_iter()
                .filter(|[a, b]| (values[*a] > level) != (values[*b] > level));
            if let [from, to] = crossed.collect::<Vec<_>>()[..] {
                pieces.push([from, to]);
            }
        }
    }
    let mut lines = Vec::new();
    while let Some([from, to]) = pieces.pop() {
        let mut line = std::collections::VecDeque::from([from, to]);
        while let Some(next) = pieces
            .iter()
            .position(|[a, b]| [line[0], line[line.len() - 1]].iter().any(|end| end == a || end == b))
        {
            let [a, b] = pieces.swap_remove(next);
            match (line[0], line[line.len() - 1]) {
                (_, last) if last == a => line.push_back(b),
                (_, last) if last == b => line.push_back(a),
                (first, _) if first == a => line.push_front(b),
                _ => line.push_front(a),
            }
        }
        lines.push(line.into_iter().map(crossing).collect());
    }
    lines
}

/// From a straight snake to a coiled one: vertices along straight lines above, the rigid blend below.
fn rigid_blend() -> Result<Figure, Box<dyn Error>> {
    const STEPS: usize = 5;
    const FLAT: [f64; 2] = [140.0, 62.0];
    let (scene, mapping) = mapped("snake")?;
    let pose = |name: &str| mapping.poses.index_of(name).ok_or(format!("no pose '{name}'"));
    let (from, to) = (pose("straight")?, pose("coil")?);
    let blend = RigidBlend::new(&mapping.poses, &BlendOptions::default())?;
    let mut figure = Figure::new([STEPS, 2], FLAT);
    for step in 0..STEPS {
        let mut weights = vec![0.0; scene.poses.len()];
        weights[to] = step as f64 / (STEPS - 1) as f64;
        weights[from] = 1.0 - weights[to];
        let poses = mapping.poses.positions();
        let straight: Vec<Point> = poses[from]
            .iter()
            .zip(&poses[to])
            .map(|(a, b)| a * weights[from] + b * weights[to])
            .collect();
        let mut rigid = Vec::new();
        blend.blend(&weights, &mut blend.scratch(), &mut rigid)?;
        for (row, positions) in [straight, rigid].into_iter().enumerate() {
            let boundary: Vec<Point> = mapping.rings[0].iter().map(|vertex| positions[*vertex]).collect();
            // One scale for all, that of the straight snake, so that lengths can be compared.
            let fit = Fit::new([step, row], FLAT, &poses[from]).centred(&boundary);
            figure.area(&fit.places(&boundary, 0.3), "#4a8f5c");
        }
    }
    Ok(figure)
}

/// From one face to another: drawings cross-faded as pixels above, their curves below.
fn curves() -> Result<Figure, Box<dyn Error>> {
    const SHARES: [f64; 3] = [0.25, 0.5, 0.75];
    const FACE: usize = 170;
    let mut sheet = Frame::filled(SHARES.len() * FACE, 2 * FACE, [255; 4]);
    for (row, art) in [ArtChoice::Pixels, ArtChoice::Curves].into_iter().enumerate() {
        let mut scene = Scene::open(&data("face"))?;
        scene.art = art;
        let character = scene.character([FACE, FACE], 2)?;
        let pose = |name: &str| character.poses().iter().position(|pose| pose == name);
        let (from, to) = pose("calm_left")
            .zip(pose("laugh_right"))
            .ok_or("the face lacks a pose")?;
        for (column, share) in SHARES.into_iter().enumerate() {
            let mut weights = vec![0.0; character.poses().len()];
            (weights[from], weights[to]) = (1.0 - share, share);
            let mut frame = character.frame_of(&weights)?;
            frame.put_before([255; 4]);
            for (k, pixels) in frame.pixels.chunks_exact(FACE).enumerate() {
                let start = (row * FACE + k) * sheet.width + column * FACE;
                sheet.pixels[start..start + FACE].copy_from_slice(pixels);
            }
        }
    }
    Figure::of_picture(&sheet)
}

/// The radial basis of three examples on a line, and in black a value that is blended by it.
fn cardinal_basis() -> Result<Figure, Box<dyn Error>> {
    const PLACES: [f64; 3] = [0.15, 0.30, 0.75];
    const VALUES: [f64; 3] = [0.9, 1.4, 0.6];
    const STEPS: usize = 120;
    let basis = RbfWeights::new(&PLACES.map(|x| vec![x]), &RbfOptions::default())?;
    let mut figure = Figure::new([3, 1], CELL);
    let place = |x: f64, value: f64| Point::new(3.0 * CELL[0] * (0.03 + 0.94 * x), CELL[1] * (0.72 - 0.42 * value));
    for (value, width) in [(0.0, 1.0), (1.0, 0.5)] {
        figure.line(&[place(0.0, value), place(1.0, value)], "#999", width);
    }
    let along: Vec<f64> = (0..=STEPS).map(|k| k as f64 / STEPS as f64).collect();
    let weights: Vec<Vec<f64>> = along
        .iter()
        .map(|x| basis.weights_at(&[*x]))
        .collect::<Result<_, _>>()?;
    let curve = |value: &dyn Fn(&[f64]) -> f64| -> Vec<Point> {
        let pairs = along.iter().zip(&weights);
        pairs.map(|(x, weights)| place(*x, value(weights))).collect()
    };
    for example in 0..PLACES.len() {
        figure.line(&curve(&|weights| weights[example]), &hue(example as f64 / 3.0), 1.6);
    }
    figure.line(
        &curve(&|weights| weights.iter().zip(VALUES).map(|(w, v)| w * v).sum()),
        "#111",
        2.2,
    );
    for (x, value) in PLACES.into_iter().zip(VALUES) {
        figure.dot(place(x, value), 3.5);
    }
    Ok(figure)
}

/// The space of a shape, as the command draws it.
fn contact_sheet() -> Result<Figure, Box<dyn Error>> {
    const SIZE: [u32; 2] = [540, 897];
    let scene = ShapeScene::open(&data("shapes/bendable"))?;
    let sheet = ShapeModel::open(&scene)?.sheet(&scene, Some(SIZE))?;
    Figure::of_picture(&sheet)
}

/// A figure in the making.
struct Figure {
    size: [f64; 2],
    text: String,
}

impl Figure {
    /// Of so many columns and rows of cells.
    fn new([columns, rows]: [usize; 2], cell: [f64; 2]) -> Self {
        Self {
            size: [columns as f64 * cell[0], rows as f64 * cell[1]],
            text: String::new(),
        }
    }

    /// Nothing but a picture.
    fn of_picture(frame: &Frame) -> Result<Self, Box<dyn Error>> {
        let (width, height) = (frame.width, frame.height);
        let data = BASE64_STANDARD.encode(png_with_palette(frame)?);
        let mut figure = Self {
            size: [width as f64, height as f64],
            text: String::new(),
        };
        figure.element(format!(
            r#"<image width="{width}" height="{height}" href="data:image/png;base64,{data}"/>"#
        ));
        Ok(figure)
    }

    fn area(&mut self, points: &[Point], colour: &str) {
        self.element(format!(r#"<path d="{}Z" fill="{colour}"/>"#, path_of(points)));
    }

    fn line(&mut self, points: &[Point], colour: &str, width: f64) {
        let style = format!(r#"fill="none" stroke="{colour}" stroke-width="{width}""#);
        self.element(format!(r#"<path d="{}" {style}/>"#, path_of(points)));
    }

    fn dot(&mut self, at: Point, radius: f64) {
        self.element(format!(
            r##"<circle cx="{:.1}" cy="{:.1}" r="{radius}" fill="#222"/>"##,
            at.x, at.y
        ));
    }

    fn element(&mut self, text: String) {
        self.text += &text;
        self.text.push('\n');
    }

    fn save(&self, folder: &Path, name: &str, label: &str) -> Drawn {
        let [width, height] = self.size;
        let mut text = String::new();
        let size = format!(r#"viewBox="0 0 {width} {height}" width="{width}" style="max-width:100%""#);
        let role = format!(r#"role="img" aria-label="{label}""#);
        writeln!(text, r#"<svg xmlns="http://www.w3.org/2000/svg" {size} {role}>"#)?;
        let paper = format!(r##"width="{width}" height="{height}" rx="6" fill="#fff""##);
        writeln!(text, "<rect {paper}/>")?;
        writeln!(text, "{}</svg>", self.text)?;
        if text.len() > MOST_BYTES {
            return Err(format!("{name}.svg has {} bytes, more than {MOST_BYTES}", text.len()).into());
        }
        Ok(std::fs::write(folder.join(format!("{name}.svg")), text)?)
    }
}

/// Where points go so that what they enclose fills a cell.
#[derive(Clone, Copy)]
struct Fit {
    scale: f64,
    shift: Point,
    centre: Point,
}

impl Fit {
    fn new([column, row]: [usize; 2], cell: [f64; 2], points: &[Point]) -> Self {
        let (low, high) = point::bounding_box(points).unwrap_or_default();
        let size = Point::from(cell);
        let scale = FILLED * size.component_div(&(high - low)).min();
        let centre = Point::new(column as f64 + 0.5, row as f64 + 0.5).component_mul(&size);
        Self {
            scale,
            shift: centre - (low + high) * (0.5 * scale),
            centre,
        }
    }

    /// A fit of this scale, with the middle of `points` in the middle of the cell.
    fn centred(self, points: &[Point]) -> Self {
        let (low, high) = point::bounding_box(points).unwrap_or_default();
        Self {
            shift: self.centre - (low + high) * (0.5 * self.scale),
            ..self
        }
    }

    fn place(&self, p: Point) -> Point {
        p * self.scale + self.shift
    }

    /// The points on the page without those that stay within `slack` pixels of the one before.
    fn places(&self, points: &[Point], slack: f64) -> Vec<Point> {
        let mut kept: Vec<Point> = Vec::new();
        for (k, p) in points.iter().enumerate() {
            let placed = self.place(*p);
            if k + 1 == points.len() || kept.last().is_none_or(|last| (placed - last).norm() > slack) {
                kept.push(placed);
            }
        }
        kept
    }
}

/// A path's commands, each point relative to the one before, in tenths of a pixel that do not add up to more.
fn path_of(points: &[Point]) -> String {
    let tenths = |p: &Point| [p.x, p.y].map(|v| (10.0 * v).round() as i64);
    let mut text = String::new();
    let mut before = [0, 0];
    for (k, p) in points.iter().enumerate() {
        let here = tenths(p);
        let [x, y] = [0, 1].map(|axis| (here[axis] - before[axis]) as f64 / 10.0);
        let joint = match k {
            0 => "M",
            1 => "l",
            _ => " ",
        };
        text += &format!("{joint}{x} {y}");
        before = here;
    }
    text
}

/// A clear colour of a hue in turns.
fn hue(turns: f64) -> String {
    let channel = |shift: f64| {
        let wave = 0.5 + 0.5 * (std::f64::consts::TAU * (turns - shift)).cos();
        (255.0 * (0.15 + 0.7 * wave)).round() as u8
    };
    format!(
        "#{:02x}{:02x}{:02x}",
        channel(0.0),
        channel(1.0 / 3.0),
        channel(2.0 / 3.0)
    )
}
