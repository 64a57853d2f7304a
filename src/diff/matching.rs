//! Which nodes and clips of two files belong together.

use super::rig::Rig;
use serde::Serialize;
use std::collections::HashMap;
use std::hash::Hash;

/// How two things found each other where their names did not do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
#[non_exhaustive]
pub enum By {
    /// The names from the root down to them are the same; a node without a name counts
    /// as the child that it is.
    Path,
    /// Several have this name; the first belongs to the first, and so on.
    Order,
    /// Neither has a name; both have this index in their file.
    Index,
    /// They are the only ones in their files.
    Alone,
}

impl By {
    /// How, in words.
    pub fn words(self) -> &'static str {
        match self {
            By::Path => "by its path in the tree",
            By::Order => "by its order among those of this name",
            By::Index => "by its index",
            By::Alone => "as the only one of its file",
        }
    }
}

/// Two things of the same kind, as indices into their files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pair {
    pub(super) a: usize,
    pub(super) b: usize,
    /// None where a name that each file has once brought them together.
    pub(super) by: Option<By>,
}

/// Names in the second file for names in the first.
#[derive(Clone, Debug, Default)]
pub(super) struct Map<'a>(HashMap<&'a str, &'a str>);

impl<'a> Map<'a> {
    pub(super) fn new(pairs: &'a [(String, String)]) -> Map<'a> {
        Map(pairs.iter().map(|(old, new)| (old.as_str(), new.as_str())).collect())
    }

    fn name(&self, name: &str) -> String {
        self.0.get(name).copied().unwrap_or(name).to_owned()
    }

    fn names(&self, names: &[Option<String>]) -> Vec<Option<String>> {
        names.iter().map(|name| name.as_deref().map(|name| self.name(name))).collect()
    }
}

/// Pairs of nodes, in the order of the first file.
pub(super) fn nodes(a: &Rig, b: &Rig, map: &Map) -> Vec<Pair> {
    let names = |rig: &Rig| rig.joints.iter().map(|joint| joint.name.clone()).collect::<Vec<_>>();
    let mut matching = Matching::new(map.names(&names(a)), names(b));
    matching.by_name();
    let mut paths = Paths::default();
    matching.unique(Some(By::Path), &paths.of(a, map), &paths.of(b, &Map::default()));
    matching.rest();
    matching.done()
}

/// Pairs of clips, in the order of the first file.
pub(super) fn clips(a: &[Option<String>], b: &[Option<String>], map: &Map) -> Vec<Pair> {
    let mut matching = Matching::new(map.names(a), b.to_vec());
    matching.by_name();
    matching.rest();
    if let ([_], [_], []) = (a, b, &matching.pairs[..]) {
        matching.pair(0, 0, Some(By::Alone));
    }
    matching.done()
}

/// A number for each path from the top of a tree down, by its parent's and its last step.
/// Written out, the paths of a deep tree would take the square of its depth.
#[derive(Default)]
struct Paths(HashMap<(Option<usize>, String), usize>);

impl Paths {
    fn of(&mut self, rig: &Rig, map: &Map) -> Vec<Option<usize>> {
        let mut paths = vec![None; rig.joints.len()];
        for &joint in &rig.order {
            let parent = rig.joints[joint].parent.and_then(|parent| paths[parent]);
            let (step, next) = (rig.step(joint, |name| map.name(name)), self.0.len());
            paths[joint] = Some(*self.0.entry((parent, step)).or_insert(next));
        }
        paths
    }
}

/// Two lists of names of which more and more are taken.
struct Matching {
    a: Vec<Option<String>>,
    b: Vec<Option<String>>,
    free_a: Vec<bool>,
    free_b: Vec<bool>,
    pairs: Vec<Pair>,
}

impl Matching {
    fn new(a: Vec<Option<String>>, b: Vec<Option<String>>) -> Matching {
        let (free_a, free_b) = (vec![true; a.len()], vec![true; b.len()]);
        Matching { a, b, free_a, free_b, pairs: Vec::new() }
    }

    fn pair(&mut self, a: usize, b: usize, by: Option<By>) {
        (self.free_a[a], self.free_b[b]) = (false, false);
        self.pairs.push(Pair { a, b, by });
    }

    /// Pairs what is free and has a key that no other free one in its file has.
    fn unique<K: Clone + Eq + Hash>(&mut self, by: Option<By>, a: &[Option<K>], b: &[Option<K>]) {
        let free = |keys: &[Option<K>], free: &[bool]| -> Vec<Option<K>> {
            keys.iter().zip(free).map(|(key, &free)| key.clone().filter(|_| free)).collect()
        };
        let (a, b) = (free(a, &self.free_a), free(b, &self.free_b));
        let in_b = once(&b);
        let found = once(&a).into_iter().filter_map(|(key, at)| Some((at?, (*in_b.get(key)?)?)));
        let mut found: Vec<(usize, usize)> = found.collect();
        found.sort_unstable();
        found.into_iter().for_each(|(a, b)| self.pair(a, b, by));
    }

    fn by_name(&mut self) {
        let (a, b) = (self.a.clone(), self.b.clone());
        self.unique(None, &a, &b);
    }

    /// Pairs what is left: the same names in their order, then those without a name by
    /// their index.
    fn rest(&mut self) {
        let mut waiting: HashMap<String, Vec<usize>> = HashMap::new();
        for (index, name) in self.b.iter().enumerate().rev().filter(|(index, _)| self.free_b[*index]) {
            if let Some(name) = name {
                waiting.entry(name.clone()).or_default().push(index);
            }
        }
        for index in (0..self.a.len()).filter(|&index| self.free_a[index]).collect::<Vec<_>>() {
            match &self.a[index] {
                Some(name) => {
                    if let Some(other) = waiting.get_mut(name).and_then(Vec::pop) {
                        self.pair(index, other, Some(By::Order));
                    }
                }
                None => {
                    let nameless = self.b.get(index).is_some_and(Option::is_none);
                    if nameless && self.free_b[index] {
                        self.pair(index, index, Some(By::Index));
                    }
                }
            }
        }
    }

    fn done(mut self) -> Vec<Pair> {
        self.pairs.sort_by_key(|pair| pair.a);
        self.pairs
    }
}

/// Where each key stands that stands there once; None where it does so more often.
fn once<K: Eq + Hash>(keys: &[Option<K>]) -> HashMap<&K, Option<usize>> {
    let mut places = HashMap::new();
    for (index, key) in keys.iter().enumerate() {
        if let Some(key) = key {
            places.entry(key).and_modify(|place| *place = None).or_insert(Some(index));
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::tests::{glb, open};
    use serde_json::{Value, json};

    fn rig(nodes: Value) -> Rig {
        Rig::of(&open(glb(&json!({"asset": {"version": "2.0"}, "nodes": nodes}), &[])).unwrap()).unwrap()
    }

    fn matched(a: Value, b: Value, map: &[(&str, &str)]) -> Vec<(usize, usize, Option<By>)> {
        let map: Vec<(String, String)> =
            map.iter().map(|(old, new)| (old.to_string(), new.to_string())).collect();
        let pairs = nodes(&rig(a), &rig(b), &Map::new(&map));
        pairs.into_iter().map(|pair| (pair.a, pair.b, pair.by)).collect()
    }

    #[test]
    fn names_come_first_wherever_they_stand() {
        let a = json!([{"name": "top", "children": [1]}, {"name": "low"}, {"name": "gone"}]);
        let b = json!([{"name": "low", "children": [1]}, {"name": "top"}]);
        assert_eq!(matched(a.clone(), b.clone(), &[]), [(0, 1, None), (1, 0, None)]);
        let swapped = [("top", "low"), ("low", "top")];
        assert_eq!(matched(a, b, &swapped), [(0, 0, None), (1, 1, None)]);
    }

    #[test]
    fn double_and_missing_names_are_matched_by_path() {
        // Two hands, one to each arm, and a finger without a name; the other way round.
        let a = json!([
            {"name": "left", "children": [2]}, {"name": "right", "children": [3]},
            {"name": "hand"}, {"name": "hand", "children": [4]}, {},
        ]);
        let b = json!([
            {"name": "hand", "children": [1]}, {},
            {"name": "right", "children": [0]}, {"name": "left", "children": [4]}, {"name": "hand"},
        ]);
        let path = Some(By::Path);
        assert_eq!(
            matched(a, b, &[]),
            [(0, 3, None), (1, 2, None), (2, 4, path), (3, 0, path), (4, 1, path)]
        );
    }

    #[test]
    fn what_is_left_is_matched_by_order_and_by_index() {
        let a = json!([{"name": "x"}, {"name": "x"}, {"children": [3]}, {}, {}]);
        let b = json!([{"name": "x"}, {"name": "x"}, {"name": "top", "children": [3]}, {}, {"name": "x"}]);
        let order = Some(By::Order);
        assert_eq!(matched(a, b, &[]), [(0, 0, order), (1, 1, order), (3, 3, Some(By::Index))]);
    }

    #[test]
    fn clips_are_matched_by_name_or_alone() {
        let names = |names: &[&str]| -> Vec<Option<String>> {
            names.iter().map(|name| (!name.is_empty()).then(|| name.to_string())).collect()
        };
        let by = |a: &[&str], b: &[&str]| -> Vec<(usize, usize, Option<By>)> {
            let pairs = clips(&names(a), &names(b), &Map::default());
            pairs.into_iter().map(|pair| (pair.a, pair.b, pair.by)).collect()
        };
        assert_eq!(by(&["walk", "run"], &["run", "swim"]), [(1, 0, None)]);
        assert_eq!(by(&["walk"], &["Take 001"]), [(0, 0, Some(By::Alone))]);
        assert_eq!(by(&["walk"], &["swim", "fly"]), []);
        assert_eq!(by(&["", "walk"], &["", "walk"]), [(0, 0, Some(By::Index)), (1, 1, None)]);
    }

    #[test]
    fn rings_are_cut_and_end() {
        let ring = json!([{"children": [1]}, {"children": [2]}, {"children": [0, 2, 9]}, {"children": [0]}]);
        let rig = rig(ring);
        assert_eq!(rig.order.len(), 4);
        let steps = [2, 1, 0].map(|node| rig.step(node, str::to_owned));
        assert_eq!(steps, ["#0", "#0", "#1"]);
        assert_eq!((rig.joints[2].parent, rig.joints[1].parent), (Some(1), Some(0)));
    }
}
