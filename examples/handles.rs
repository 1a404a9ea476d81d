//! A drawing's mesh bent by handles, as under a pointer. `cargo run --example handles -- FOLDER` writes `bent.svg` there.

use std::path::{Path, PathBuf};

use inbetween::pose::HandleDeformation;
use inbetween::{Point, Scene, map_layer};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: handles FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let scene = Scene::open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("data/snake/scene.toml"))?;
    let (mapping, _) = map_layer(&scene.layer_spec(0)?)?;
    let (topology, rest) = (mapping.poses.topology(), &mapping.poses.positions()[0]);
    // The first pose is a straight snake: its ends are handles, one of them is dragged.
    let left = *rest.iter().min_by(|a, b| a.x.total_cmp(&b.x)).ok_or("an empty mesh")?;
    let right = *rest.iter().max_by(|a, b| a.x.total_cmp(&b.x)).ok_or("an empty mesh")?;
    let deformation = HandleDeformation::new(topology, rest, &[left, right])?;
    let (mut scratch, mut bent) = (deformation.scratch(), Vec::new());
    let way = Point::new(0.5 * (left.x - right.x), 0.4 * (left.x - right.x));
    for step in 1..=10 {
        // Each drag goes on from where the last one ended.
        let pointer = right + way * (f64::from(step) / 10.0);
        deformation.drag(&[left, pointer], &mut scratch, &mut bent)?;
    }
    let triangle = |corners: &[usize; 3]| {
        let [a, b, c] = corners.map(|vertex| format!("{:.1} {:.1}", bent[vertex].x, bent[vertex].y));
        format!("M{a} L{b} L{c} Z")
    };
    let lines: String = topology.triangles().iter().map(triangle).collect();
    let (low, high) = bent
        .iter()
        .fold((left, left), |(low, high), p| (low.inf(p), high.sup(p)));
    let [x, y, width, height] = [low.x, low.y, high.x - low.x, high.y - low.y];
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="{x} {y} {width} {height}"><path d="{lines}" fill="none" stroke="black"/></svg>"#
    );
    Ok(std::fs::write(folder.join("bent.svg"), svg)?)
}
