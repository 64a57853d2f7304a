//! The outer form: header and chunks of a `.glb`, and how its JSON is padded.

use super::{Code, Report};
use crate::asset::Asset;
use crate::asset::container::{BIN, Chunk, Container, Glb, JSON};

pub(super) fn check(asset: &Asset, report: &mut Report) {
    let json_start = match asset.container() {
        Container::Glb(glb) => {
            lengths(glb, report);
            chunks(glb, report);
            glb.chunks.first().map_or(0, |chunk| chunk.start)
        }
        Container::Text { .. } => 0,
    };
    let text = asset.json_form();
    if text.byte_order_mark {
        report.add(
            Code::JsonByteOrderMark,
            json_start,
            "the JSON must begin with `{` and begins with a byte-order mark; save it as UTF-8 without one",
        );
    }
    if text.zero_padded {
        report.add(
            Code::JsonPadding,
            json_start + asset.json().len() as u64,
            "the JSON must be padded with spaces and is padded with zero bytes",
        );
    }
    unused_binary(asset, report);
}

fn lengths(glb: &Glb, report: &mut Report) {
    let (declared, length) = (glb.declared, glb.length);
    if declared > length {
        report.add(
            Code::GlbTruncated,
            8,
            format!(
                "the header says {declared} bytes and the file has {length}; it was cut short: make it again"
            ),
        );
    } else if declared < length {
        report.add(
            Code::GlbTrailingData,
            declared,
            format!("the header says {declared} bytes and the file has {length}; remove the rest or correct the header"),
        );
    } else if glb.end < length {
        report.add(
            Code::GlbTrailingData,
            glb.end,
            format!("{} bytes follow the last chunk that can be read; remove them", length - glb.end),
        );
    }
}

fn chunks(glb: &Glb, report: &mut Report) {
    for (index, chunk) in glb.chunks.iter().enumerate() {
        let Chunk { kind, start, declared, length } = *chunk;
        let (header, name) = (start - 8, kind.escape_ascii());
        if declared > length {
            report.add(
                Code::GlbChunkTruncated,
                header,
                format!("chunk `{name}` says it has {declared} bytes, and the file has {length} left; it was cut short: make it again"),
            );
        }
        if declared % 4 != 0 {
            report.add(
                Code::GlbChunkAlignment,
                header,
                format!("chunk `{name}` has {declared} bytes, not a multiple of 4; pad it"),
            );
        }
        if (kind == JSON && index != 0) || (kind == BIN && index != 1) {
            report.add(
                Code::GlbChunkOrder,
                header,
                format!("chunk {index} is `{name}`; JSON must be chunk 0 and BIN chunk 1, each once"),
            );
        } else if kind != JSON && kind != BIN {
            report.add(
                Code::GlbUnknownChunk,
                header,
                format!("chunk {index} is `{name}`, of {declared} bytes; glTF 2.0 knows JSON and BIN, viewers skip others"),
            );
        }
    }
}

/// Bytes of the binary chunk that no buffer claims.
fn unused_binary(asset: &Asset, report: &mut Report) {
    let Some((start, length)) = asset.container().bin() else {
        return;
    };
    let first = asset.root().buffers.first();
    let used = first.filter(|buffer| buffer.uri.is_none());
    let used = used.map_or(0, |buffer| buffer.byte_length.0);
    if length > used.saturating_add(3) {
        report.add(
            Code::GlbBinUnused,
            start,
            format!("the BIN chunk has {length} bytes and buffer 0 uses {used} of them; leave out the rest"),
        );
    }
}
