//! The catalogue of findings: each with a code that stays the same, how
//! serious it is, and what it means. `docs/checks.md` is made of it.

use serde::Serialize;

/// How serious a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing.
    Info,
    /// Viewers differ in what they show.
    Warning,
    /// The specification is broken, or playback is wrong.
    Error,
}

impl std::fmt::Display for Severity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Severity::Info => "info",
            Severity::Warning => "warning",
            Severity::Error => "error",
        })
    }
}

macro_rules! catalogue {
    ($($name:ident $text:literal $severity:ident $meaning:literal)*) => {
        /// What kind of finding it is.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $(#[doc = $meaning] $name,)*
        }

        impl Code {
            /// All codes, in the order in which a file is looked at.
            pub const ALL: &[Code] = &[$(Code::$name),*];

            /// The code as it is printed.
            pub fn as_str(self) -> &'static str {
                match self { $(Code::$name => $text),* }
            }

            /// How serious such a finding is.
            pub fn severity(self) -> Severity {
                match self { $(Code::$name => Severity::$severity),* }
            }

            /// What such a finding means, a sentence.
            pub fn meaning(self) -> &'static str {
                match self { $(Code::$name => $meaning),* }
            }
        }
    };
}

catalogue! {
    GlbTruncated "GLB_TRUNCATED" Error "The file is shorter than its header says."
    GlbTrailingData "GLB_TRAILING_DATA" Error "The file goes on after its last chunk or beyond the length in its header."
    GlbChunkTruncated "GLB_CHUNK_TRUNCATED" Error "A chunk reaches past the end of the file."
    GlbChunkAlignment "GLB_CHUNK_ALIGNMENT" Error "A chunk's length is not a multiple of 4."
    GlbChunkOrder "GLB_CHUNK_ORDER" Error "A JSON or BIN chunk is not where it belongs: JSON first, BIN second, each once."
    GlbUnknownChunk "GLB_UNKNOWN_CHUNK" Info "A chunk of a type that glTF 2.0 does not define; viewers skip it."
    GlbBinUnused "GLB_BIN_UNUSED" Warning "The BIN chunk holds more than the padding that buffer 0 leaves over, or no buffer uses it."
    JsonPadding "JSON_PADDING" Error "The JSON is padded with zero bytes instead of spaces."
    JsonByteOrderMark "JSON_BYTE_ORDER_MARK" Error "The JSON begins with a byte-order mark."
    Schema "SCHEMA" Error "The JSON lacks a required property, or one is of the wrong type."
    JsonPartlyUnread "JSON_PARTLY_UNREAD" Warning "The JSON is nested too deeply, or holds a number too large, for all of it to be looked at; viewers may refuse it."
    Version "VERSION" Error "The file asks for another version of glTF than 2.x."
    ExtensionRequired "EXTENSION_REQUIRED" Warning "The file needs an extension that not all viewers know and this check does not look into."
    ExtensionUndeclared "EXTENSION_UNDECLARED" Error "An extension is required but not listed as used."
    IndexOutOfRange "INDEX_OUT_OF_RANGE" Error "An index refers to an object that does not exist."
    InvalidValue "INVALID_VALUE" Error "A value is not one of those that glTF allows."
    MissingValue "MISSING_VALUE" Error "A value that glTF requires is missing."
    BufferUnreadable "BUFFER_UNREADABLE" Error "A buffer cannot be read: the file is missing, its URI is broken, or there is no BIN chunk."
    BufferTooShort "BUFFER_TOO_SHORT" Error "A buffer has fewer bytes than its byteLength says."
    ViewBounds "VIEW_BOUNDS" Error "A buffer view reaches past the end of its buffer."
    ViewStride "VIEW_STRIDE" Error "A byteStride is not a multiple of 4 from 4 to 252, or smaller than an element."
    ViewUses "VIEW_USES" Error "A buffer view holds data of several kinds, of vertices, indices, images or other."
    AccessorBounds "ACCESSOR_BOUNDS" Error "An accessor reaches past the end of its buffer view."
    AccessorAlignment "ACCESSOR_ALIGNMENT" Error "An accessor does not begin at a multiple of its component's size."
    SparseIndices "SPARSE_INDICES" Error "The indices of sparse elements do not rise, or exceed the accessor."
    NotFinite "NOT_FINITE" Error "Numbers are NaN or infinite."
    MinMaxMissing "MIN_MAX_MISSING" Error "Keyframe times and vertex positions must state their min and max."
    MinMaxWrong "MIN_MAX_WRONG" Error "The stated min or max is not that of the data."
    AttributeType "ATTRIBUTE_TYPE" Error "Vertex data or indices are of a type that glTF does not allow for them."
    AttributeCount "ATTRIBUTE_COUNT" Error "The attributes of a primitive differ in their number of vertices."
    VertexIndex "VERTEX_INDEX" Error "Indices name vertices that do not exist."
    NodeCycle "NODE_CYCLE" Error "Nodes are their own ancestors."
    NodeTwoParents "NODE_TWO_PARENTS" Error "A node is the child of two nodes, or twice of one."
    SceneNodeNotRoot "SCENE_NODE_NOT_ROOT" Error "A scene lists a node that has a parent."
    NodeMatrixAndTrs "NODE_MATRIX_AND_TRS" Error "A node has a matrix and a translation, rotation or scale."
    NodeRotation "NODE_ROTATION" Error "A node's rotation is not a unit quaternion."
    DuplicateName "DUPLICATE_NAME" Warning "Nodes, or clips, have the same name; Blender renames them."
    NameTooLong "NAME_TOO_LONG" Info "Blender cuts names to 63 bytes."
    AnimationEmpty "ANIMATION_EMPTY" Error "An animation has no channels or no samplers."
    ChannelWithoutNode "CHANNEL_WITHOUT_NODE" Info "A channel names no node; only an extension can make use of it."
    ChannelTwice "CHANNEL_TWICE" Error "Two channels of a clip target the same property of the same node."
    AnimatedMatrix "ANIMATED_MATRIX" Error "An animated node has a matrix instead of translation, rotation and scale."
    WeightsWithoutTargets "WEIGHTS_WITHOUT_TARGETS" Error "Morph weights are animated on a node whose mesh has no morph targets."
    InputType "INPUT_TYPE" Error "Keyframe times are not float scalars."
    OutputType "OUTPUT_TYPE" Error "Keyframe values are of a type that glTF does not allow for the property."
    OutputCount "OUTPUT_COUNT" Error "The number of values does not fit the number of keys."
    CubicsplineOneKey "CUBICSPLINE_ONE_KEY" Error "CUBICSPLINE needs two keys or more."
    SamplerStride "SAMPLER_STRIDE" Error "Key times or values lie in a buffer view with a byteStride."
    TimeNegative "TIME_NEGATIVE" Error "Keys lie before t = 0."
    TimeNotIncreasing "TIME_NOT_INCREASING" Error "Keyframe times are not strictly increasing."
    KeysTooClose "KEYS_TOO_CLOSE" Warning "Keys are less than 0.42 ms apart; Blender merges them at 24 fps."
    NoKeyAtZero "NO_KEY_AT_ZERO" Warning "The first key is not at t = 0; viewers differ in what they show before it."
    TimesBlurred "TIMES_BLURRED" Warning "Times are so late that float32 can hardly tell neighbouring keys apart."
    RotationNotUnit "ROTATION_NOT_UNIT" Error "Rotations are not unit quaternions; viewers that do not normalise show a scaled mesh."
    RotationSignFlip "ROTATION_SIGN_FLIP" Warning "Neighbouring rotations have opposite signs; viewers that use nlerp (Blender) rotate the long way."
    RotationLargeStep "ROTATION_LARGE_STEP" Warning "LINEAR rotations are more than 18° apart; the playback error in Blender (nlerp) exceeds 0.007°."
    RotationJump "ROTATION_JUMP" Info "A rotation jumps: more than 18° within 1.5 ms."
    UnusedObject "UNUSED_OBJECT" Info "Nothing refers to this object."
    ChannelLengths "CHANNEL_LENGTHS" Info "The channels of a clip end at different times; the shorter ones hold their last value."
    ClipLengths "CLIP_LENGTHS" Info "The clips of the file differ in length."
    MotionDiffers "MOTION_DIFFERS" Error "The playback error against the curve through the input's keyframes exceeds the limit."
    InputChanged "INPUT_CHANGED" Warning "The input is not the one the file was converted from."
    NothingVisible "NOTHING_VISIBLE" Error "A rendered frame of the file is almost empty."
    NothingMoves "NOTHING_MOVES" Warning "Rendered frames at different times are identical though channels change."
    DifferenceLimit "DIFFERENCE_LIMIT" Error "The motion of a node differs between the files by more than the limit."
    NothingInCommon "NOTHING_IN_COMMON" Error "The files have no node, or no clip, in common to compare."
    OnlyInOne "ONLY_IN_ONE" Warning "Present in only one of the files."
    MatchedOtherwise "MATCHED_OTHERWISE" Info "Names are missing, duplicate or different; matched by path or order instead."
    LengthDiffers "LENGTH_DIFFERS" Info "A clip differs in length between the files; the shorter one holds its last pose."
    Outdated "OUTDATED" Error "The file is missing or out of date with its inputs and options."
    NotCompared "NOT_COMPARED" Info "A channel that only an extension can play was not compared."
}

impl Code {
    /// Where on the page of the catalogue it stands.
    pub fn anchor(self) -> String {
        self.as_str().to_ascii_lowercase().replace('_', "-")
    }

    /// The catalogue as a Markdown table.
    pub fn table() -> String {
        let mut table = String::from("| Code | Severity | Meaning |\n|---|---|---|\n");
        for code in Code::ALL {
            let (text, severity, meaning) = (code.as_str(), code.severity(), code.meaning());
            table += &format!("| <a name=\"{}\"></a>`{text}` | {severity} | {meaning} |\n", code.anchor());
        }
        table
    }
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

impl Serialize for Code {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_docs_hold_this_catalogue() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/checks.md");
        let docs = std::fs::read_to_string(path).unwrap().replace("\r\n", "\n");
        let table = Code::table();
        if !docs.contains(&table) {
            panic!("docs/checks.md must hold exactly this table:\n{table}");
        }
    }

    #[test]
    fn codes_are_unique_and_loud() {
        let mut seen = std::collections::HashSet::new();
        for code in Code::ALL {
            let text = code.as_str();
            assert!(seen.insert(text), "{text}");
            assert!(text.chars().all(|c| c.is_ascii_uppercase() || c == '_'), "{text}");
        }
    }
}
