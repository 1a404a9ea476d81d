//! What it costs to read a large drawing: `cargo bench --bench input`, a minute.
//!
//! 4,000 x 4,000 pixels, PNG in memory, on all processors, since that is how it is waited for: a figure that is cut out, the same painted on grey paper,
//! and in ink on white. The most memory that the thread which asks has at once, the file's bytes not counted, is printed for each.

use std::io::{Cursor, Write as _};

use brief::brief;
use criterion::{Criterion, criterion_group, criterion_main};
use image::{ImageFormat, Rgba, RgbaImage};
use inbetween::input::{BitmapOptions, read_bitmap};

#[path = "common/brief.rs"]
mod brief;

const SIDE: u32 = 4000;

/// How a drawing is made.
#[derive(Clone, Copy)]
enum Kind {
    CutOut,
    Painted,
    Ink,
}

/// The bytes of a figure of discs and bars.
fn drawing(kind: Kind) -> Vec<u8> {
    let scale = 400.0 / f64::from(SIDE);
    let inside = |x: f64, y: f64, grown: f64| {
        let disc = |a: f64, b: f64, radius: f64| (x - a).hypot(y - b) < radius + grown;
        let bar = |a: [f64; 2], b: [f64; 2], half: f64| {
            let (u, v) = (b[0] - a[0], b[1] - a[1]);
            let t = (((x - a[0]) * u + (y - a[1]) * v) / (u * u + v * v)).clamp(0.0, 1.0);
            (x - a[0] - t * u).hypot(y - a[1] - t * v) < half + grown
        };
        disc(200.0, 110.0, 60.0)
            || bar([200.0, 170.0], [200.0, 250.0], 45.0)
            || bar([200.0, 190.0], [90.0, 240.0], 16.0)
            || bar([200.0, 190.0], [310.0, 150.0], 16.0)
            || bar([180.0, 250.0], [150.0, 360.0], 20.0)
            || bar([220.0, 250.0], [250.0, 360.0], 20.0)
    };
    let image = RgbaImage::from_fn(SIDE, SIDE, |column, row| {
        let (x, y) = (f64::from(column) * scale, f64::from(row) * scale);
        let grain = ((column.wrapping_mul(0x9e37_79b1) ^ row.wrapping_mul(0x85eb_ca77)) >> 29) as u8;
        Rgba(match (kind, inside(x, y, 0.0)) {
            (Kind::CutOut, true) => [200, 60 + grain, 40, 255],
            (Kind::CutOut, false) => [0; 4],
            (Kind::Painted, true) => [200, 60 + grain, 40, 255],
            (Kind::Painted, false) => [225 - grain, 225 - grain, 222 - grain, 255],
            (Kind::Ink, true) if !inside(x, y, -3.0) => [30 + grain, 30, 34, 255],
            (Kind::Ink, _) => [250 - grain, 250 - grain, 248 - grain, 255],
        })
    });
    let mut bytes = Vec::new();
    image
        .write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png)
        .expect("encoded");
    bytes
}

fn input(criterion: &mut Criterion) {
    let mut group = brief(criterion, "input 4000 x 4000");
    let kinds = [
        ("cut out", Kind::CutOut),
        ("painted", Kind::Painted),
        ("ink", Kind::Ink),
    ];
    for (name, kind) in kinds {
        let bytes = drawing(kind);
        let options = BitmapOptions::default();
        let used = allocation_counter::measure(|| {
            read_bitmap(&bytes, &options).expect("a drawing");
        });
        let said = writeln!(
            std::io::stderr(),
            "{name}: at most {:.0} MB at once",
            used.bytes_max as f64 / 1e6
        );
        said.expect("written");
        group.bench_function(name, |b| b.iter(|| read_bitmap(&bytes, &options)));
    }
    group.finish();
}

criterion_group!(benches, input);
criterion_main!(benches);
