//! A look at a file as a person would take it: is anything there, does it
//! move?

use super::error::Error;
use super::layer::covered;
use super::session::{Session, close_up};
use super::view::Style;
use crate::asset::play::{Channel, Keys, Property};
use crate::asset::{self, Asset};

/// Less than this share of pixels drawn is nothing to be seen.
pub const LEAST_VISIBLE: f64 = 0.001;
/// Clips that are looked at; a small file can list one very often.
const MOST_CLIPS: usize = 64;
/// Where in a clip to look whether anything moves.
const MOMENTS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// What a look at a file shows.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Look {
    /// The largest share of pixels, 0 to 1, drawn in any picture looked at.
    pub covered: f64,
    /// A finding for each clip that was looked at, in the file's order: the first 64.
    pub clips: Vec<ClipLook>,
    /// What the pictures were drawn with.
    pub renderer: String,
    /// What was not drawn or done otherwise than asked, a sentence each.
    pub notes: Vec<String>,
}

impl Look {
    /// Whether there is anything to be seen.
    pub fn visible(&self) -> bool {
        self.covered >= LEAST_VISIBLE
    }
}

/// What a look at one clip shows.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ClipLook {
    /// Its index in the file's `animations`.
    pub animation: usize,
    /// Its name, where it has one.
    pub name: Option<String>,
    /// Whether its pictures differ; `None` where no channel changes anything
    /// that this crate draws.
    pub moves: Option<bool>,
}

impl Session {
    /// Looks at the file half way through its first clip, and at its clips.
    pub fn look(&mut self, asset: &mut Asset, size: (u32, u32)) -> Result<Look, Error> {
        let mut covered = self.covered_close_up(asset, size)?;
        let mut clips = Vec::new();
        for clip in 0..self.clips.len().min(MOST_CLIPS) {
            clips.push(ClipLook {
                animation: self.clips[clip].animation,
                name: self.clips[clip].name.clone(),
                moves: match self.changes(asset, clip)? {
                    true => Some(self.moves(asset, clip, size, &mut covered)?),
                    false => None,
                },
            });
        }
        let mut notes = self.notes().to_vec();
        if self.clips.len() > MOST_CLIPS {
            notes.push(format!("the first {MOST_CLIPS} of {} clips were looked at", self.clips.len()));
        }
        Ok(Look { covered, clips, renderer: self.renderer().to_owned(), notes })
    }

    /// Seen from where the pose alone fills the view, as in a view that holds a
    /// wide motion even a sound file may be small; and, if that is too far to
    /// see a long thin thing, from where its largest part does.
    fn covered_close_up(&mut self, asset: &mut Asset, size: (u32, u32)) -> Result<f64, Error> {
        let clip = self.clip(None)?;
        let pose = self.pose(asset, clip, self.duration(clip) * 0.5)?;
        let frame = close_up(pose.corners(&self.model), size)?;
        let share = covered(&self.draw(&pose, &frame, size, &[])?);
        let Some(corners) = pose.largest(&self.model).filter(|_| share < LEAST_VISIBLE) else {
            return Ok(share);
        };
        let closer = close_up(corners, size)?;
        Ok(share.max(covered(&self.draw(&pose, &closer, size, &[])?)))
    }

    fn moves(
        &mut self,
        asset: &mut Asset,
        clip: usize,
        size: (u32, u32),
        most: &mut f64,
    ) -> Result<bool, Error> {
        let duration = self.duration(Some(clip));
        let style = Style { size, ..Style::default() };
        let view = self.view(asset, &[Some(clip)], &style, false)?;
        let mut layer = |t: f64| {
            let pose = self.pose(asset, Some(clip), t)?;
            self.draw(&pose, &view.frame(&pose, 0.0), size, &[])
        };
        let first = layer(0.0)?;
        *most = most.max(covered(&first));
        for moment in &MOMENTS[1..] {
            let layer = layer(duration * moment)?;
            *most = most.max(covered(&layer));
            if layer != first {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether a clip has a channel whose keys differ, of those that are
    /// drawn: morph weights and joints are not.
    fn changes(&self, asset: &mut Asset, clip: usize) -> Result<bool, Error> {
        for channel in &self.clips[clip].channels {
            let drawn = channel.property != Property::MorphTargetWeights
                && !self.model.joints.contains(&channel.node);
            if drawn && changes(asset, channel)? {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// Whether what is stored for a channel's keys differs from key to key.
fn changes(asset: &mut Asset, channel: &Channel) -> Result<bool, asset::Error> {
    let mut keys = Keys::new(channel);
    let mut first: Option<Vec<f32>> = None;
    while let Some(block) = keys.next(asset)? {
        let mut stored = block.values.chunks_exact(channel.stored_width());
        let first = first.get_or_insert_with(|| stored.next().unwrap_or_default().to_vec());
        if stored.any(|key| key != first) {
            return Ok(true);
        }
    }
    Ok(false)
}
