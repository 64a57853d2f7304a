//! Accessors: typed elements in a buffer, read a block at a time.
//!
//! The layout rules are those of glTF 2.0, section 3.6.2: elements a stride
//! apart, columns of matrices on four-byte bounds, normalised integers, and
//! sparse elements that replace others.

use std::ops::Range;

use gltf::json::accessor::{ComponentType, Type, sparse};
use gltf::json::validation::{Checked, USize64};

use super::{Asset, Error};

/// Bytes read at once.
const BLOCK: u64 = 1 << 20;

/// The most elements taken from an accessor that stores none and so stands
/// for zeros, unless the file has more bytes: nothing else backs its count.
const ZEROS: u64 = 1 << 14;

/// What an accessor holds, and where; checked against the bytes that exist.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Number of elements.
    pub count: usize,
    /// Numbers in an element: 3 for a `VEC3`.
    pub components: usize,
    /// The stored type of each number.
    pub component: ComponentType,
    /// Integers stand for fractions of their range.
    pub normalized: bool,
    pointer: String,
    /// `None` where all elements that are not sparse are zero.
    elements: Option<Elements>,
    sparse: Option<Sparse>,
}

/// Elements in a buffer.
#[derive(Clone, Debug)]
struct Elements {
    buffer: usize,
    /// Byte of the first element in the buffer.
    start: u64,
    /// Bytes from element to element.
    stride: u64,
    layout: Layout,
}

/// The bytes of one element: columns, a vector being one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    columns: u64,
    column_size: u64,
    column_stride: u64,
}

#[derive(Clone, Debug)]
struct Sparse {
    count: u64,
    index_type: ComponentType,
    indices: Elements,
    values: Elements,
}

/// Bytes in a buffer that are known to exist.
pub(super) struct Span {
    pub(super) buffer: usize,
    pub(super) start: u64,
    pub(super) length: u64,
    stride: Option<u64>,
}

impl Layout {
    pub(crate) fn new(kind: Type, component: ComponentType) -> Layout {
        let size = component.size() as u64;
        let (columns, rows) = match kind {
            Type::Mat2 => (2, 2),
            Type::Mat3 => (3, 3),
            Type::Mat4 => (4, 4),
            vector => (1, vector.multiplicity() as u64),
        };
        let column_size = rows * size;
        let column_stride = match columns {
            1 => column_size,
            _ => column_size.next_multiple_of(4),
        };
        Layout { columns, column_size, column_stride }
    }

    /// Bytes from the first to the last that holds a number.
    pub(crate) fn size(self) -> u64 {
        self.column_stride * (self.columns - 1) + self.column_size
    }

    /// Bytes from element to element where no stride is given.
    pub(crate) fn stride(self) -> u64 {
        self.column_stride * self.columns
    }

    /// Bytes from the first of `count` elements to the end of the last.
    pub(crate) fn span(self, stride: u64, count: u64) -> u128 {
        match count.checked_sub(1) {
            Some(steps) => u128::from(steps) * u128::from(stride) + u128::from(self.size()),
            None => 0,
        }
    }
}

impl Asset {
    /// What the accessor holds.
    ///
    /// Fails where it does not fit into its buffer view, or that not into its
    /// buffer, so that all elements of a shape can be read.
    pub fn shape(&mut self, accessor: usize) -> Result<Shape, Error> {
        let pointer = format!("/accessors/{accessor}");
        let wrong = |problem: &str| Error::data(pointer.clone(), problem);
        let stored = self.root.accessors.get(accessor);
        let stored = stored.ok_or_else(|| wrong("there is no such accessor"))?;
        let (Checked::Valid(component), Checked::Valid(kind)) = (&stored.component_type, &stored.type_)
        else {
            return Err(wrong("its type or componentType is not one of glTF's"));
        };
        let (component, kind, normalized) = (component.0, *kind, stored.normalized);
        let (view, offset, count) = (stored.buffer_view, stored.byte_offset, stored.count.0);
        let sparse = stored.sparse.clone();
        let layout = Layout::new(kind, component);
        let elements = match view {
            Some(view) => Some(self.elements(&pointer, view.value(), offset, count, layout)?),
            None if count > ZEROS && count > self.stored_bytes() => {
                return Err(wrong("has no bufferView, and more elements than are filled with zeros here"));
            }
            None => None,
        };
        let sparse = match sparse {
            Some(sparse) => Some(self.sparse(&pointer, &sparse, layout)?),
            None => None,
        };
        Ok(Shape {
            count: usize::try_from(count).map_err(|_| wrong("has too many elements"))?,
            components: kind.multiplicity(),
            component,
            normalized,
            pointer,
            elements,
            sparse,
        })
    }

    /// Elements of an accessor as numbers, those of an element side by side;
    /// normalised integers as the fractions they stand for.
    pub fn floats(&mut self, accessor: usize, elements: Range<usize>) -> Result<Vec<f32>, Error> {
        let shape = self.shape(accessor)?;
        let mut out = Vec::new();
        self.floats_into(&shape, elements, &mut out)?;
        Ok(out)
    }

    /// [`Asset::floats`] of a known shape, into `out`, which is cleared first.
    pub fn floats_into(
        &mut self,
        shape: &Shape,
        elements: Range<usize>,
        out: &mut Vec<f32>,
    ) -> Result<(), Error> {
        let range = shape.checked(&elements)?;
        let numbers = elements.len() * shape.components;
        out.clear();
        match &shape.elements {
            Some(stored) => {
                out.reserve(numbers);
                self.each_run(stored, range.clone(), |bytes| {
                    push_floats(shape.component, shape.normalized, bytes, out);
                })?;
            }
            None => out.resize(numbers, 0.0),
        }
        self.replace_sparse(shape, range, |asset, values, into, from| {
            let mut one = Vec::new();
            asset.each_run(values, from..from + 1, |bytes| {
                push_floats(shape.component, shape.normalized, bytes, &mut one);
            })?;
            let at = into * shape.components;
            out[at..at + one.len()].copy_from_slice(&one);
            Ok(())
        })
    }

    /// The elements of a scalar accessor of unsigned integers, as those that
    /// join vertices to triangles.
    pub fn indices(&mut self, accessor: usize) -> Result<Vec<u32>, Error> {
        let shape = self.shape(accessor)?;
        let mut out = Vec::new();
        self.indices_into(&shape, 0..shape.count, &mut out)?;
        Ok(out)
    }

    /// Elements of a scalar integer accessor, into `out`, which is cleared
    /// first.
    pub(crate) fn indices_into(
        &mut self,
        shape: &Shape,
        elements: Range<usize>,
        out: &mut Vec<u32>,
    ) -> Result<(), Error> {
        let unsigned = matches!(shape.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if !unsigned || shape.components != 1 {
            return Err(Error::data(shape.pointer.clone(), "must hold single unsigned integers"));
        }
        let range = shape.checked(&elements)?;
        out.clear();
        match &shape.elements {
            Some(stored) => {
                out.reserve(elements.len());
                self.each_run(stored, range.clone(), |bytes| {
                    push_integers(shape.component, bytes, out);
                })?;
            }
            None => out.resize(elements.len(), 0),
        }
        self.replace_sparse(shape, range, |asset, values, into, from| {
            let mut one = Vec::new();
            asset.each_run(values, from..from + 1, |bytes| {
                push_integers(shape.component, bytes, &mut one);
            })?;
            out[into] = one[0];
            Ok(())
        })
    }

    /// The indices of an accessor's sparse elements.
    pub(crate) fn sparse_indices(&mut self, shape: &Shape) -> Result<Vec<u32>, Error> {
        let mut indices = Vec::new();
        if let Some(sparse) = &shape.sparse {
            self.each_run(&sparse.indices, 0..sparse.count, |bytes| {
                push_integers(sparse.index_type, bytes, &mut indices);
            })?;
        }
        Ok(indices)
    }

    /// Where a buffer view lies; it is checked to exist.
    pub(super) fn view_span(&mut self, view: usize) -> Result<Span, Error> {
        let pointer = format!("/bufferViews/{view}");
        let Some(stored) = self.root.buffer_views.get(view) else {
            return Err(Error::data(pointer, "there is no such buffer view"));
        };
        let span = Span {
            buffer: stored.buffer.value(),
            start: stored.byte_offset.unwrap_or_default().0,
            length: stored.byte_length.0,
            stride: stored.byte_stride.map(|stride| stride.0 as u64),
        };
        let available = self.buffer_length(span.buffer)?;
        match span.start.checked_add(span.length) {
            Some(end) if end <= available => Ok(span),
            _ => Err(Error::data(
                pointer,
                format!(
                    "takes {} bytes from byte {} of a buffer that has {available}",
                    span.length, span.start
                ),
            )),
        }
    }

    fn elements(
        &mut self,
        pointer: &str,
        view: usize,
        offset: Option<USize64>,
        count: u64,
        layout: Layout,
    ) -> Result<Elements, Error> {
        let wrong = |problem: String| Error::data(pointer, problem);
        let span = self.view_span(view)?;
        let offset = offset.unwrap_or_default().0;
        // Some writers say 0 for "one after the other".
        let stride = span.stride.filter(|&stride| stride > 0);
        let stride = stride.unwrap_or(layout.stride());
        if stride < layout.size() {
            return Err(wrong(format!("its elements of {} bytes are only {stride} apart", layout.size())));
        }
        let end = u128::from(offset) + layout.span(stride, count);
        if end > u128::from(span.length) {
            return Err(wrong(format!("reaches to byte {end} of a buffer view that has {}", span.length)));
        }
        Ok(Elements { buffer: span.buffer, start: span.start + offset, stride, layout })
    }

    fn sparse(&mut self, pointer: &str, stored: &sparse::Sparse, layout: Layout) -> Result<Sparse, Error> {
        let at = |part: &str| format!("{pointer}/sparse/{part}");
        let Checked::Valid(index_type) = &stored.indices.component_type else {
            let problem = "its componentType must be an unsigned integer";
            return Err(Error::data(at("indices"), problem));
        };
        let count = stored.count.0;
        let (indices, values) = (&stored.indices, &stored.values);
        Ok(Sparse {
            count,
            index_type: index_type.0,
            indices: self.elements(
                &at("indices"),
                indices.buffer_view.value(),
                Some(indices.byte_offset),
                count,
                Layout::new(Type::Scalar, index_type.0),
            )?,
            values: self.elements(
                &at("values"),
                values.buffer_view.value(),
                Some(values.byte_offset),
                count,
                layout,
            )?,
        })
    }

    /// Reads elements a block at a time and hands out runs of their numbers'
    /// bytes, without what lies between them.
    fn each_run(
        &mut self,
        elements: &Elements,
        range: Range<u64>,
        mut run: impl FnMut(&[u8]),
    ) -> Result<(), Error> {
        let Elements { stride, layout, .. } = *elements;
        let size = layout.size();
        let dense = stride == size && layout.column_size == layout.column_stride;
        let per_block = (BLOCK.saturating_sub(size) / stride) + 1;
        let mut block = Vec::new();
        let mut first = range.start;
        while first < range.end {
            let count = per_block.min(range.end - first);
            // At most a block, or one element.
            block.resize(((count - 1) * stride + size) as usize, 0);
            self.read_at(elements.buffer, elements.start + first * stride, &mut block)?;
            if dense {
                run(&block);
            } else {
                for element in block.chunks(stride as usize) {
                    for column in element[..size as usize].chunks(layout.column_stride as usize) {
                        run(&column[..layout.column_size as usize]);
                    }
                }
            }
            first += count;
        }
        Ok(())
    }

    /// Calls `replace` for each sparse element within `range`, with its place
    /// in the range and its place among the sparse values.
    fn replace_sparse(
        &mut self,
        shape: &Shape,
        range: Range<u64>,
        mut replace: impl FnMut(&mut Asset, &Elements, usize, u64) -> Result<(), Error>,
    ) -> Result<(), Error> {
        const AT_ONCE: u64 = 1 << 16;
        let Some(sparse) = &shape.sparse else {
            return Ok(());
        };
        let mut first = 0;
        while first < sparse.count {
            let last = sparse.count.min(first + AT_ONCE);
            let mut indices = Vec::new();
            self.each_run(&sparse.indices, first..last, |bytes| {
                push_integers(sparse.index_type, bytes, &mut indices);
            })?;
            for (from, index) in (first..last).zip(indices) {
                if range.contains(&u64::from(index)) {
                    // Within the range, whose length fits usize.
                    let into = (u64::from(index) - range.start) as usize;
                    replace(self, &sparse.values, into, from)?;
                }
            }
            first = last;
        }
        Ok(())
    }
}

impl Shape {
    /// The range as it is used on files, known to lie within the accessor.
    fn checked(&self, elements: &Range<usize>) -> Result<Range<u64>, Error> {
        if elements.start <= elements.end && elements.end <= self.count {
            return Ok(elements.start as u64..elements.end as u64);
        }
        Err(Error::data(
            self.pointer.clone(),
            format!("has {} elements, and {elements:?} were asked for", self.count),
        ))
    }
}

/// Appends numbers as section 3.11 of the specification converts them.
fn push_floats(component: ComponentType, normalized: bool, bytes: &[u8], out: &mut Vec<f32>) {
    let signed = |value: f32, top: f32| {
        if normalized { (value / top).max(-1.0) } else { value }
    };
    let unsigned = |value: f32, top: f32| if normalized { value / top } else { value };
    let pairs = bytes.as_chunks().0.iter();
    let fours = bytes.as_chunks().0.iter();
    match component {
        ComponentType::F32 => out.extend(fours.map(|b| f32::from_le_bytes(*b))),
        ComponentType::I8 => out.extend(bytes.iter().map(|&b| signed(f32::from(b.cast_signed()), 127.0))),
        ComponentType::U8 => out.extend(bytes.iter().map(|&b| unsigned(f32::from(b), 255.0))),
        ComponentType::I16 => {
            out.extend(pairs.map(|b| signed(f32::from(i16::from_le_bytes(*b)), 32767.0)));
        }
        ComponentType::U16 => {
            out.extend(pairs.map(|b| unsigned(f32::from(u16::from_le_bytes(*b)), 65535.0)));
        }
        ComponentType::U32 => {
            let top = u32::MAX as f32;
            out.extend(fours.map(|b| unsigned(u32::from_le_bytes(*b) as f32, top)));
        }
    }
}

/// Appends unsigned integers.
fn push_integers(component: ComponentType, bytes: &[u8], out: &mut Vec<u32>) {
    match component {
        ComponentType::U8 => out.extend(bytes.iter().map(|&b| u32::from(b))),
        ComponentType::U16 => {
            let pairs = bytes.as_chunks().0.iter();
            out.extend(pairs.map(|b| u32::from(u16::from_le_bytes(*b))));
        }
        _ => out.extend(bytes.as_chunks().0.iter().map(|b| u32::from_le_bytes(*b))),
    }
}
