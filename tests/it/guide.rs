//! The guide says nothing that the program does not do: its scenes are scenes, its commands are commands, and its figures are there.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use inbetween::scene::{Scene, ShapeScene};

/// Poses for the pieces of scene files that are about something else.
const POSES: &str = "\n[[pose]]\nname = \"stand\"\nsource = \"stand.png\"\nat = [0, 0]\n\
                     [[pose]]\nname = \"run\"\nsource = \"run.png\"\nat = [1, 0]\n";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The chapters: file and text.
fn chapters() -> Vec<(PathBuf, String)> {
    let folder = std::fs::read_dir(root().join("src/guide")).expect("the guide");
    let files = folder.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> = files
        .filter(|file| file.extension().is_some_and(|e| e == "rs"))
        .collect();
    files.sort();
    assert!(files.len() > 8, "only {} chapters were found", files.len());
    let text = |file: &PathBuf| std::fs::read_to_string(file).expect("readable");
    files.iter().map(|file| (file.clone(), text(file))).collect()
}

/// The blocks of one language in Markdown, or in the comments of a chapter.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let lines = text.lines().map(|line| {
        let said = line.strip_prefix("//!").unwrap_or(line);
        said.strip_prefix(' ').unwrap_or(said)
    });
    let mut found: Vec<String> = Vec::new();
    let mut is_inside = false;
    for line in lines {
        if let Some(begun) = line.strip_prefix("```") {
            is_inside = !is_inside && begun == language;
            if is_inside {
                found.push(String::new());
            }
        } else if let Some(block) = found.last_mut().filter(|_| is_inside) {
            *block += line;
            block.push('\n');
        }
    }
    found
}

#[test]
fn every_scene_file_of_the_guide_is_read() {
    let mut count = 0;
    for (file, text) in chapters() {
        for block in blocks(&text, "toml") {
            count += 1;
            let path = Path::new("guide/scene.toml");
            let version = if block.contains("version = ") {
                ""
            } else {
                "version = 1\n"
            };
            let poses = if block.contains("[[pose]]") { "" } else { POSES };
            let refused = if block.contains("adjectives") {
                ShapeScene::parse(&block, path).err()
            } else {
                Scene::parse(&format!("{version}{block}{poses}"), path).err()
            };
            assert!(
                refused.is_none(),
                "{}: {}\n{block}",
                file.display(),
                refused.map(|error| error.to_string()).unwrap_or_default()
            );
        }
    }
    assert!(count > 15, "only {count} scene files were found");
}

/// All keys of a scene file, whatever table they are in.
fn keys(value: &toml::Value, found: &mut BTreeSet<String>) {
    match value {
        toml::Value::Table(table) => {
            for (key, value) in table {
                found.insert(key.clone());
                keys(value, found);
            }
        }
        toml::Value::Array(list) => list.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

#[test]
fn the_chapter_on_the_scene_file_has_every_key() {
    let chapter = std::fs::read_to_string(root().join("src/guide/scene_file.rs")).expect("the chapter");
    let mut described = BTreeSet::new();
    for block in blocks(&chapter, "toml") {
        keys(&block.parse::<toml::Table>().expect("TOML").into(), &mut described);
    }
    let format = std::fs::read_to_string(root().join("src/scene/file.rs")).expect("the format");
    let fields = format
        .lines()
        .filter_map(|line| line.trim().strip_prefix("pub(super) "));
    let fields = fields.filter_map(|field| field.split_once(": ").map(|(name, _)| name));
    // The one key that is a word of Rust.
    let known: BTreeSet<&str> = fields
        .map(|name| if name == "looped" { "loop" } else { name })
        .collect();
    assert!(known.len() > 50, "only {} keys were found", known.len());
    let missing: Vec<&&str> = known.iter().filter(|key| !described.contains(**key)).collect();
    assert!(missing.is_empty(), "the chapter does not say what {missing:?} are");
}

#[test]
fn every_command_of_the_guide_and_of_the_readme_is_one() {
    let mut texts = chapters();
    let readme = root().join("README.md");
    texts.push((readme.clone(), std::fs::read_to_string(readme).expect("the README")));
    let mut help: BTreeMap<String, String> = BTreeMap::new();
    let mut count = 0;
    for (file, text) in texts {
        let blocks = [blocks(&text, "text"), blocks(&text, "sh")].concat().join("\n");
        let commands = blocks.lines().filter_map(|line| {
            let verb = line.strip_prefix("cargo run --release -- ");
            verb.or_else(|| line.strip_prefix("inbetween "))
        });
        for command in commands {
            count += 1;
            // What explains the command stands after two spaces.
            let words: Vec<&str> = command.split("  ").next().unwrap_or_default().split(' ').collect();
            let verbs = if words[0] == "shape" { 2 } else { 1 };
            let verb = words[..verbs].join(" ");
            let help = help.entry(verb.clone()).or_insert_with(|| {
                let mut asked = Command::new(env!("CARGO_BIN_EXE_inbetween"));
                let told = asked.arg("help").args(&words[..verbs]).output().expect("the command");
                assert!(told.status.success(), "{}: there is no verb '{verb}'", file.display());
                String::from_utf8(told.stdout).expect("text")
            });
            for word in words.iter().filter(|word| word.starts_with('-') && word.len() > 1) {
                let option = word.split('=').next().unwrap_or_default();
                let is_known = help
                    .split(|c: char| c.is_whitespace() || c == ',')
                    .any(|known| known == option);
                assert!(is_known, "{}: '{verb}' has no option {option}", file.display());
            }
        }
    }
    assert!(count > 30, "only {count} commands were found");
}

#[test]
fn the_guide_is_documentation_and_its_figures_fit_a_page() {
    for (file, text) in chapters() {
        for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with("//!")) {
            let is_documentation = line.starts_with("#![doc = include_str!(") || line.starts_with("pub mod ");
            assert!(is_documentation, "{}: '{line}' is code", file.display());
        }
    }
    let figures = std::fs::read_dir(root().join("src/guide/figures")).expect("the figures");
    let figures: Vec<PathBuf> = figures.map(|entry| entry.expect("an entry").path()).collect();
    assert!(figures.len() > 4, "only {} figures were found", figures.len());
    for file in figures {
        let text = std::fs::read_to_string(&file).expect("readable");
        let is_fit = text.len() <= 60_000 && text.lines().all(|line| !line.is_empty());
        assert!(
            is_fit && text.starts_with("<svg "),
            "{} is no figure for a page",
            file.display()
        );
    }
}
