//! The numbers in accessors: finite, and their min and max as stated.

use gltf::json::accessor::ComponentType;
use serde_json::Value;

use super::{Code, Report, Shared};
use crate::asset::{Error, Shape};

/// The extremes of an accessor's components, and numbers that are none.
struct Extremes {
    min: Vec<f32>,
    max: Vec<f32>,
    not_finite: u64,
    first_not_finite: Option<usize>,
}

/// Checks an accessor's numbers; whether they are finite only if `finite`.
pub(super) fn check(
    shared: &Shared<'_>,
    accessor: usize,
    finite: bool,
    report: &mut Report,
) -> Result<(), Error> {
    let place = format!("/accessors/{accessor}");
    let (shape, min, max) = {
        let mut asset = shared.asset();
        let shape = asset.shape(accessor)?;
        let stored = &asset.root().accessors[accessor];
        (shape, stored.min.clone(), stored.max.clone())
    };
    sparse_indices(shared, &shape, &place, report)?;
    let finite = finite && shape.component == ComponentType::F32;
    if min.is_none() && max.is_none() && !finite {
        return Ok(());
    }
    let mut extremes = Extremes {
        min: vec![f32::INFINITY; shape.components],
        max: vec![f32::NEG_INFINITY; shape.components],
        not_finite: 0,
        first_not_finite: None,
    };
    // The stated extremes of normalised integers are the integers.
    shared.blocks(accessor, true, |first, block| {
        for (i, element) in block.chunks_exact(shape.components).enumerate() {
            extremes.next(first + i, element);
        }
    })?;
    if let Some(first) = extremes.first_not_finite.filter(|_| finite) {
        report.add(
            Code::NotFinite,
            place.clone(),
            format!(
                "{} of {} elements hold NaN or infinity, the first is element {first}",
                extremes.not_finite, shape.count
            ),
        );
    }
    for (name, stated, found) in [("min", min, &extremes.min), ("max", max, &extremes.max)] {
        if let Some(stated) = stated.filter(|stated| !same(stated, found)) {
            report.add(
                Code::MinMaxWrong,
                format!("{place}/{name}"),
                format!("says {stated} and the data's {name} is {found:?}; correct it"),
            );
        }
    }
    Ok(())
}

/// Indices of sparse elements rise and stay within the accessor.
fn sparse_indices(shared: &Shared<'_>, shape: &Shape, place: &str, report: &mut Report) -> Result<(), Error> {
    let indices = shared.asset().sparse_indices(shape)?;
    let beyond = indices.last().is_some_and(|&last| last as usize >= shape.count);
    if beyond || !indices.is_sorted_by(|a, b| a < b) {
        report.add(
            Code::SparseIndices,
            format!("{place}/sparse/indices"),
            format!("must rise from each to the next and stay below {}", shape.count),
        );
    }
    Ok(())
}

impl Extremes {
    #[inline]
    fn next(&mut self, index: usize, element: &[f32]) {
        let mut finite = true;
        let sides = self.min.iter_mut().zip(&mut self.max);
        for (&x, (min, max)) in element.iter().zip(sides) {
            finite &= x.is_finite();
            *min = min.min(x);
            *max = max.max(x);
        }
        if !finite {
            self.not_finite += 1;
            self.first_not_finite.get_or_insert(index);
        }
    }
}

/// Whether the JSON states these very float32 numbers.
fn same(stated: &Value, found: &[f32]) -> bool {
    let Some(stated) = stated.as_array() else {
        return false;
    };
    let number = |value: &Value| value.as_f64().map(|x| x as f32);
    stated.len() == found.len() && stated.iter().zip(found).all(|(value, x)| number(value) == Some(*x))
}
