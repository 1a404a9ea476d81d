//! Weights over the pose space.
