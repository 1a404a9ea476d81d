//! Shrinking of poses by leaving out what they consist of.

use proptest::prelude::*;
use proptest::strategy::{NewTree, ValueTree};
use proptest::test_runner::TestRunner;

use crate::math::Point;
use crate::outline::{Outline, Ring};

/// A strategy whose cases shrink by parts: poses are left out, then holes, then vertices in all poses at once, halves of
/// what is left first and single ones at last.
#[derive(Debug)]
pub(crate) struct Shrinking<S>(pub(crate) S);

impl<S: Strategy<Value = Vec<Outline>>> Strategy for Shrinking<S> {
    type Tree = Parts;
    type Value = Vec<Outline>;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        let poses = self.0.new_tree(runner)?.current();
        Ok(Parts {
            share: 2,
            at: 0,
            stage: Stage::Poses,
            before: None,
            poses,
        })
    }
}

/// What is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Poses,
    Holes,
    Vertices,
    Done,
}

/// A case that is being shrunk.
#[derive(Debug, Clone)]
pub(crate) struct Parts {
    poses: Vec<Outline>,
    /// The poses before the last step, until it is confirmed.
    before: Option<Vec<Outline>>,
    stage: Stage,
    /// Vertices are left out in runs of their count over this.
    share: usize,
    /// The next part to be left out.
    at: usize,
}

impl ValueTree for Parts {
    type Value = Vec<Outline>;

    fn current(&self) -> Vec<Outline> {
        self.poses.clone()
    }

    fn simplify(&mut self) -> bool {
        // Whatever was left out before may stay out.
        self.before = None;
        while self.stage != Stage::Done {
            let Some(smaller) = self.without_next() else { continue };
            self.before = Some(std::mem::replace(&mut self.poses, smaller));
            return true;
        }
        false
    }

    fn complicate(&mut self) -> bool {
        let Some(before) = self.before.take() else { return false };
        // The part is needed: it comes back, and the next one is tried.
        let length = self.run();
        self.poses = before;
        self.at += length;
        true
    }
}

impl Parts {
    /// How many vertices are left out at once; 1 of anything else.
    fn run(&self) -> usize {
        match self.stage {
            Stage::Vertices => (self.poses[0].outer().len() / self.share).max(1),
            _ => 1,
        }
    }

    /// The poses without the next part, or `None` and a step on if that cannot be.
    fn without_next(&mut self) -> Option<Vec<Outline>> {
        let first = &self.poses[0];
        let (count, next) = match self.stage {
            Stage::Poses => (self.poses.len(), Stage::Holes),
            Stage::Holes => (first.holes().len(), Stage::Vertices),
            Stage::Vertices => (first.outer().len(), Stage::Done),
            Stage::Done => return None,
        };
        let run = self.run();
        if self.at >= count {
            self.at = 0;
            if self.stage == Stage::Vertices && run > 1 {
                self.share *= 2;
            } else {
                self.stage = next;
            }
            return None;
        }
        let left = match self.stage {
            Stage::Poses if count > 1 => {
                let mut poses = self.poses.clone();
                poses.remove(self.at);
                Some(poses)
            }
            Stage::Holes => self.each(|outer, holes| {
                holes.remove(self.at);
                outer
            }),
            Stage::Vertices => self.each(|mut outer, _| {
                outer.drain(self.at..(self.at + run).min(count));
                outer
            }),
            _ => None,
        };
        if left.is_none() {
            self.at += run;
        }
        left
    }

    /// Every pose changed; `None` if one is no outline any more, or runs the other way.
    fn each(&self, mut change: impl FnMut(Vec<Point>, &mut Vec<Ring>) -> Vec<Point>) -> Option<Vec<Outline>> {
        self.poses
            .iter()
            .map(|outline| {
                let mut holes = outline.holes().to_vec();
                let outer = Ring::new(change(outline.outer().points().to_vec(), &mut holes)).ok()?;
                (outer.signed_area() > 0.0).then(|| Outline::new(outer, holes).ok())?
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Kinship, Recipe, outlines};
    use super::*;

    /// The smallest case that a failure of some kind shrinks to.
    fn shrunk(poses: Vec<Outline>, fails: impl Fn(&[Outline]) -> bool) -> Vec<Outline> {
        let mut tree = Parts {
            share: 2,
            at: 0,
            stage: Stage::Poses,
            before: None,
            poses,
        };
        // As proptest does it: smaller while it fails, and back where it does not.
        while tree.simplify() {
            while !fails(&tree.current()) && tree.complicate() {
                if !tree.simplify() {
                    return tree.current();
                }
            }
        }
        tree.current()
    }

    #[test]
    fn a_case_shrinks_to_what_its_failure_needs() {
        let recipe = Recipe {
            vertices: 40,
            poses: 4,
            holes: 2,
            kinship: Kinship::Strangers,
            seed: 3,
        };
        let drawn = outlines(&recipe);
        let everything = shrunk(drawn.clone(), |_| true);
        assert_eq!(
            (
                everything.len(),
                everything[0].outer().len(),
                everything[0].holes().len()
            ),
            (1, 3, 0)
        );
        let needed = drawn[2].outer().point(17);
        let kept = shrunk(drawn, |poses| {
            poses.len() > 1 && poses.iter().any(|pose| pose.outer().points().contains(&needed))
        });
        assert!(kept.len() == 2 && kept[0].holes().is_empty());
        // Few vertices can be left out of neither without one of the poses crossing itself.
        assert!(kept[0].outer().len() < 20, "{}", kept[0].outer().len());
    }
}
