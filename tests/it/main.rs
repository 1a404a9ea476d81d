//! The tests that use the library and the command from outside, as one program: it is linked once.

mod bad_input;
mod canvas;
mod carried_drawings;
mod command;
mod copies;
mod crisp_silhouette;
mod decoders;
mod deformed;
mod drawn;
mod explorer;
mod holes;
mod import_law;
mod inner_lines;
mod layers;
mod long_work;
mod mapping_report;
mod parts;
mod scenes;
mod separate;
mod shape;
mod shape_data;
mod sheets;
mod textures;
mod truth;
mod workbench;
mod workshop;
