//! Sets of things that are united step by step (union-find).
//!
//! The smaller number stands for both, with path halving: nothing depends on the order of uniting. Source: Tarjan and van Leeuwen 1984, "Worst-case
//! analysis of set union algorithms", doi:10.1145/62.2160.

/// Things, numbered from 0, each in one set.
#[derive(Debug, Clone)]
pub(crate) struct DisjointSets {
    parents: Vec<u32>,
}

impl DisjointSets {
    /// `count` things, fewer than 2^32, each in a set of its own.
    pub(crate) fn new(count: usize) -> Self {
        Self {
            parents: (0..count as u32).collect(),
        }
    }

    /// How many things there are.
    pub(crate) fn len(&self) -> usize {
        self.parents.len()
    }

    /// Adds a thing in a set of its own, and returns its number.
    #[cfg(feature = "images")]
    pub(crate) fn add(&mut self) -> usize {
        let number = self.parents.len();
        self.parents.push(number as u32);
        number
    }

    /// The smallest number of the set that a thing is in.
    pub(crate) fn root(&mut self, thing: usize) -> usize {
        let mut thing = thing as u32;
        while self.parents[thing as usize] != thing {
            let grandparent = self.parents[self.parents[thing as usize] as usize];
            self.parents[thing as usize] = grandparent;
            thing = grandparent;
        }
        thing as usize
    }

    /// Unites the sets that two things are in, and returns what stood for them: the smaller number, which stands for both now, and the larger one.
    pub(crate) fn unite(&mut self, a: usize, b: usize) -> [usize; 2] {
        let (a, b) = (self.root(a), self.root(b));
        let [kept, gone] = [a.min(b), a.max(b)];
        self.parents[gone] = kept as u32;
        [kept, gone]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_number_stands_for_all_that_are_united() {
        let mut sets = DisjointSets::new(5);
        assert_eq!(sets.unite(4, 2), [2, 4]);
        assert_eq!(sets.unite(3, 4), [2, 3]);
        assert_eq!(sets.add(), 5);
        assert_eq!(sets.unite(5, 0), [0, 5]);
        let roots: Vec<usize> = (0..sets.len()).map(|thing| sets.root(thing)).collect();
        assert_eq!(roots, [0, 1, 2, 2, 2, 0]);
        // What is one set stays one.
        assert_eq!(sets.unite(3, 4), [2, 2]);
        assert_eq!(sets.root(3), 2);
    }
}
