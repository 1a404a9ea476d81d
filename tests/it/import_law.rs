//! The import law of ARCHITECTURE.md, held against every `use crate::` and `crate::` path of the library.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The foundations, in the order in which they may use one another.
const FOUNDATIONS: [&str; 4] = ["math", "mesh", "outline", "solve"];

/// What each stage may use of other stages: types that it consumes or hands on.
const STAGES: [(&str, &[&str]); 15] = [
    ("animation", &[]),
    // Paths of other crates become and are made of drawings' and frames' curves.
    ("interop", &["input", "render"]),
    // OBJ files hold forms.
    ("input", &["shape3d"]),
    // Parts are known by their colours.
    ("parts", &["input"]),
    ("appearance", &["input"]),
    ("matching", &["appearance"]),
    ("registration", &["appearance"]),
    ("compatible", &["matching"]),
    ("pose", &["matching"]),
    ("weights", &[]),
    ("blend", &["pose"]),
    ("texture", &[]),
    ("render", &["input", "matching", "pose"]),
    // The forms' weights are those of the radial basis; textures are blended as frames are.
    ("shape3d", &["render", "weights"]),
    // The runtime file holds poses and the blend's own options.
    ("export", &["blend", "pose", "render", "shape3d"]),
];

/// What stands above the pipeline and is not known to it: files of scenes, the command, the server.
const ABOVE_PIPELINE: [&str; 3] = ["cli", "explorer", "scene"];

/// Items of other stages that are types or modules of types; anything lower-case is a function or a module path, which
/// a stage may not reach into.
fn is_type(item: &str) -> bool {
    item.chars().next().is_some_and(char::is_uppercase)
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)
        .expect("the folder of sources")
        .map(|e| e.expect("an entry"))
    {
        let path = entry.path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// The name of the folder or file directly below `root` that holds `file`, and its path from there.
fn place_of<'a>(file: &'a Path, root: &Path) -> (String, &'a Path) {
    let inside = file.strip_prefix(root).expect("below src");
    let first = inside.components().next().expect("a name");
    (first.as_os_str().to_string_lossy().into_owned(), inside)
}

/// Every path after `crate::` in a file, as its first two segments; braces are expanded one level.
fn crate_paths(text: &str) -> BTreeSet<(String, String)> {
    let code: String = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n");
    let mut found = BTreeSet::new();
    for part in code.split("crate::").skip(1) {
        let module: String = part.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let rest = part[module.len()..].strip_prefix("::").unwrap_or("");
        let items: Vec<String> = if let Some(list) = rest.strip_prefix('{') {
            let list = list.split("};").next().unwrap_or("");
            list.split(',')
                .map(|item| item.trim().split("::").next().unwrap_or("").to_owned())
                .collect()
        } else {
            vec![rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()]
        };
        for item in items.into_iter().filter(|item| !item.is_empty()) {
            found.insert((module.clone(), item));
        }
    }
    found
}

#[test]
fn every_import_obeys_the_law() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut broken = Vec::new();
    let mut paths = 0;
    for file in sources(&root) {
        let (own, inside) = place_of(&file, &root);
        let text = std::fs::read_to_string(&file).expect("readable");
        for (module, item) in crate_paths(&text) {
            paths += 1;
            if module == own {
                continue;
            }
            let is_pipeline = own == "pipeline" || own == "pipeline.rs";
            let allowed = if is_pipeline {
                // It wires the stages together, whoever asks for it: it knows no front end.
                !ABOVE_PIPELINE.contains(&module.as_str())
            } else if own.ends_with(".rs") || ABOVE_PIPELINE.contains(&own.as_str()) {
                // lib.rs, main.rs, front ends and the command use what they need.
                true
            } else if let Some(place) = FOUNDATIONS.iter().position(|&f| f == own) {
                let may_use: &[&str] = match FOUNDATIONS[place] {
                    "math" => &[],
                    // The validity check of a mesh is stated in terms of rings.
                    "mesh" => &["math", "outline"],
                    _ => &["math"],
                };
                may_use.contains(&module.as_str())
            } else if FOUNDATIONS.contains(&module.as_str()) {
                true
            } else {
                let stage = STAGES.iter().find(|(name, _)| *name == own);
                stage.is_some_and(|(_, types)| types.contains(&module.as_str())) && is_type(&item)
            };
            if !allowed {
                broken.push(format!("{}: crate::{module}::{item}", inside.display()));
            }
        }
    }
    assert!(
        paths > 50,
        "only {paths} imports were found: the test does not read the sources any more"
    );
    assert!(broken.is_empty(), "imports against the law:\n{}", broken.join("\n"));
}

#[test]
fn files_are_touched_only_where_the_law_allows() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let may = ["input", "scene", "export", "cli", "explorer", "main.rs"];
    for file in sources(&root) {
        let (own, inside) = place_of(&file, &root);
        let text = std::fs::read_to_string(&file).expect("readable");
        let reaches = ["std::fs", "std::env", "std::time", "File::open"]
            .iter()
            .any(|path| text.contains(path));
        assert!(
            !reaches || may.contains(&own.as_str()),
            "{} reaches outside the program",
            inside.display()
        );
    }
}
