//! Names of poses and parts, each given once, and the order of the parts over all poses.

use super::layered::Candidate;

/// Gives poses of one name a number, and each part of a pose a name of its own.
pub(super) fn unite_names(candidates: &mut [Candidate]) {
    let mut taken: Vec<String> = Vec::new();
    for pose in candidates {
        pose.name = free_name(&pose.name, &taken);
        taken.push(pose.name.clone());
        let mut own: Vec<String> = Vec::new();
        for (name, _) in &mut pose.parts {
            *name = free_name(name, &own);
            own.push(name.clone());
        }
    }
}

/// The name, with a number if it is taken.
pub(super) fn free_name(name: &str, taken: &[String]) -> String {
    let numbered = (2..).map(|number| format!("{name}-{number}"));
    let mut names = std::iter::once(name.to_owned()).chain(numbered);
    names.find(|name| !taken.contains(name)).unwrap_or_default()
}

/// The names of all parts, from back to front: each stands behind what its pose has in front of it, where poses do not contradict one another.
pub(super) fn merged_order(candidates: &[Candidate]) -> Vec<String> {
    let mut order: Vec<String> = Vec::new();
    for pose in candidates {
        let mut after = 0;
        for (name, _) in &pose.parts {
            match order.iter().position(|known| known == name) {
                Some(place) => after = after.max(place + 1),
                None => {
                    order.insert(after, name.clone());
                    after += 1;
                }
            }
        }
    }
    order
}

/// The order of a pose's parts, if it is not that of the layers.
pub(super) fn own_order(pose: &Candidate, layers: &[String]) -> Option<Vec<String>> {
    let own: Vec<String> = pose.parts.iter().map(|(name, _)| name.clone()).collect();
    let usual: Vec<&String> = layers.iter().filter(|layer| own.contains(layer)).collect();
    (usual.len() == own.len() && usual.iter().zip(&own).any(|(usual, own)| *usual != own)).then_some(own)
}

#[cfg(test)]
mod tests {
    use inbetween::input::PictureChoice;
    use inbetween::scene::NewElement;

    use super::*;

    fn pose(name: &str, parts: &[&str]) -> Candidate {
        Candidate {
            name: name.to_owned(),
            source: String::new(),
            picture: PictureChoice::Only,
            whole: NewElement::Whole,
            parts: parts
                .iter()
                .map(|part| ((*part).to_owned(), format!("{name}/{part}")))
                .collect(),
        }
    }

    #[test]
    fn parts_that_only_some_poses_have_stand_where_these_have_them() {
        let poses = [
            pose("a", &["body", "head"]),
            pose("b", &["tail", "body", "scarf", "head", "hat"]),
            pose("c", &["head", "body"]),
        ];
        let order = merged_order(&poses);
        assert_eq!(order, ["tail", "body", "scarf", "head", "hat"]);
        assert_eq!(own_order(&poses[1], &order), None);
        assert_eq!(
            own_order(&poses[2], &order),
            Some(vec!["head".to_owned(), "body".to_owned()])
        );
    }

    #[test]
    fn names_are_given_once() {
        let mut poses = [pose("a", &["arm", "arm"]), pose("a", &[])];
        unite_names(&mut poses);
        assert_eq!((poses[0].name.as_str(), poses[1].name.as_str()), ("a", "a-2"));
        assert_eq!(poses[0].parts[1].0, "arm-2");
    }
}
