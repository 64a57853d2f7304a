//! Buffers, buffer views and accessors: what they claim fits into what holds
//! it. All sums are made in 128 bits, where no claim overflows.

use gltf::json::Root;
use gltf::json::accessor::{ComponentType, IndexComponentType, Type, sparse};
use gltf::json::validation::Checked;

use super::{Code, Report};
use crate::asset::{Asset, Error, Layout};

pub(super) fn check(asset: &mut Asset, report: &mut Report) {
    for buffer in 0..asset.root().buffers.len() {
        check_buffer(asset, buffer, report);
    }
    for view in 0..asset.root().buffer_views.len() {
        check_view(asset, view, report);
    }
    for accessor in 0..asset.root().accessors.len() {
        check_accessor(asset, accessor, report);
    }
}

fn check_buffer(asset: &mut Asset, buffer: usize, report: &mut Report) {
    let claimed = asset.root().buffers[buffer].byte_length.0;
    let place = format!("/buffers/{buffer}");
    if claimed == 0 {
        report.add(
            Code::InvalidValue,
            format!("{place}/byteLength"),
            "must be 1 or more; leave out a buffer without bytes",
        );
    }
    match asset.buffer_length(buffer) {
        Ok(length) if length < claimed => report.add(
            Code::BufferTooShort,
            format!("{place}/byteLength"),
            format!(
                "says {claimed} bytes, and there are {length}; the data was cut short or the number is wrong"
            ),
        ),
        Ok(_) => {}
        Err(_) if filled_by_extension(asset.root(), buffer) => {}
        Err(Error::Data { pointer, problem }) => report.add(Code::BufferUnreadable, pointer, problem),
        Err(other) => report.add(Code::BufferUnreadable, place, other.to_string()),
    }
}

/// A buffer without bytes of its own may get them by an extension, as that of
/// compressed meshes does.
pub(super) fn filled_by_extension(root: &Root, buffer: usize) -> bool {
    let stored = root.buffers.get(buffer);
    stored.is_some_and(|buffer| buffer.uri.is_none()) && !root.extensions_used.is_empty()
}

fn check_view(asset: &Asset, view: usize, report: &mut Report) {
    let root = asset.root();
    let stored = &root.buffer_views[view];
    let place = format!("/bufferViews/{view}");
    if stored.byte_length.0 == 0 {
        report.add(Code::InvalidValue, format!("{place}/byteLength"), "must be 1 or more");
    }
    if let Some(stride) = stored.byte_stride
        && (stride.0 % 4 != 0 || !(4..=252).contains(&stride.0))
    {
        report.add(
            Code::ViewStride,
            format!("{place}/byteStride"),
            format!("must be a multiple of 4 from 4 to 252 and is {}", stride.0),
        );
    }
    let Some(buffer) = root.buffers.get(stored.buffer.value()) else {
        return;
    };
    let start = stored.byte_offset.unwrap_or_default().0;
    let end = u128::from(start) + u128::from(stored.byte_length.0);
    if end > u128::from(buffer.byte_length.0) {
        report.add(
            Code::ViewBounds,
            place,
            format!(
                "reaches to byte {end} of a buffer of {}; correct byteOffset or byteLength",
                buffer.byte_length.0
            ),
        );
    }
}

fn check_accessor(asset: &Asset, accessor: usize, report: &mut Report) {
    let stored = &asset.root().accessors[accessor];
    let place = format!("/accessors/{accessor}");
    let (Checked::Valid(component), Checked::Valid(kind)) = (&stored.component_type, &stored.type_) else {
        return;
    };
    let (component, count) = (component.0, stored.count.0);
    if count == 0 {
        report.add(
            Code::InvalidValue,
            format!("{place}/count"),
            "must be 1 or more; leave out an accessor without elements",
        );
    }
    let layout = Layout::new(*kind, component);
    let offset = stored.byte_offset.unwrap_or_default().0;
    if let Some(view) = stored.buffer_view {
        let part = Part { view: view.value(), offset, count, layout, component };
        check_part(asset, &place, &part, report);
    }
    if let Some(sparse) = &stored.sparse {
        check_sparse(asset, &place, sparse, count, (layout, component), report);
    }
}

/// Elements that are said to lie in a buffer view.
struct Part {
    view: usize,
    offset: u64,
    count: u64,
    layout: Layout,
    component: ComponentType,
}

fn check_part(asset: &Asset, place: &str, part: &Part, report: &mut Report) {
    let Some(view) = asset.root().buffer_views.get(part.view) else {
        return;
    };
    let size = part.component.size() as u64;
    let start = view.byte_offset.unwrap_or_default().0;
    if !part.offset.is_multiple_of(size) || !start.is_multiple_of(size) {
        report.add(
            Code::AccessorAlignment,
            format!("{place}/byteOffset"),
            format!("begins at byte {start} + {} of its buffer; numbers of {size} bytes must begin at a multiple of {size}", part.offset),
        );
    }
    let stride = view.byte_stride.map_or(part.layout.stride(), |stride| stride.0 as u64);
    if stride < part.layout.size() {
        report.add(
            Code::ViewStride,
            format!("/bufferViews/{}/byteStride", part.view),
            format!("is {stride}, less than the {} bytes of an element of {place}", part.layout.size()),
        );
    }
    let end = u128::from(part.offset) + part.layout.span(stride, part.count);
    if end > u128::from(view.byte_length.0) {
        report.add(
            Code::AccessorBounds,
            place,
            format!(
                "its {} elements reach to byte {end} of buffer view {}, which has {}; correct count, byteOffset or the view",
                part.count, part.view, view.byte_length.0
            ),
        );
    }
}

fn check_sparse(
    asset: &Asset,
    place: &str,
    sparse: &sparse::Sparse,
    count: u64,
    (layout, component): (Layout, ComponentType),
    report: &mut Report,
) {
    if sparse.count.0 == 0 || sparse.count.0 > count {
        report.add(
            Code::SparseIndices,
            format!("{place}/sparse/count"),
            format!("must be from 1 to the accessor's {count} and is {}", sparse.count.0),
        );
    }
    let values = Part {
        view: sparse.values.buffer_view.value(),
        offset: sparse.values.byte_offset.0,
        count: sparse.count.0,
        layout,
        component,
    };
    check_part(asset, &format!("{place}/sparse/values"), &values, report);
    if let Checked::Valid(IndexComponentType(component)) = sparse.indices.component_type {
        let indices = Part {
            view: sparse.indices.buffer_view.value(),
            offset: sparse.indices.byte_offset.0,
            count: sparse.count.0,
            layout: Layout::new(Type::Scalar, component),
            component,
        };
        check_part(asset, &format!("{place}/sparse/indices"), &indices, report);
    }
}
