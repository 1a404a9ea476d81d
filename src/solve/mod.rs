//! Linear systems.
