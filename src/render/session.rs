//! A file made ready once, and any number of pictures of it.

use super::error::Error;
use super::frame::Frame;
use super::framing::Framing;
use super::gpu::Gpu;
use super::layer::Layer;
use super::load::Model;
use super::pose::Pose;
use super::scene::{Part, Scene};
use super::still::Which;
use super::view::{Style, View};
use super::{MOST_PIXELS, Renderer, camera::Camera, cpu};
use crate::asset::Asset;
use crate::asset::play::{Clip, Player};
use glam::DVec3;

/// Moments between a clip's ends at which it is looked at to find how far its
/// motion reaches.
const FRAMING_MOMENTS: u32 = 64;
/// Multiples of the golden ratio, without their whole parts, lie evenly and yet
/// fall into step with no turning part, however many turns a clip has.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A file's geometry and a renderer, for any number of pictures.
///
/// The asset that it was made from is read again for every pose: hand in the
/// same one.
#[derive(Debug)]
pub struct Session {
    pub(super) model: Model,
    pub(super) clips: Vec<Clip>,
    player: Player,
    canvas: Canvas,
    /// Whether the renderer may be given up for the built-in one.
    may_fall_back: bool,
    notes: Vec<String>,
    /// The view found last, and for which clips, with or without a turntable.
    found: Option<(Vec<Which>, bool, View)>,
}

/// What pictures are drawn with.
#[derive(Debug)]
enum Canvas {
    Gpu(Box<Gpu>),
    Cpu,
}

impl Session {
    /// Reads the geometry and finds the renderer.
    pub fn new(asset: &mut Asset, renderer: Renderer) -> Result<Self, Error> {
        let model = Model::load(asset);
        let mut notes = model.notes.clone();
        let canvas = match renderer {
            Renderer::Cpu => Canvas::Cpu,
            Renderer::Wgpu => gpu(&model)?,
            Renderer::Auto => gpu(&model).unwrap_or_else(|error| {
                notes.push(fallen_back(&error));
                Canvas::Cpu
            }),
        };
        Ok(Session {
            clips: asset.clips(),
            model,
            player: Player::new(),
            canvas,
            may_fall_back: renderer == Renderer::Auto,
            notes,
            found: None,
        })
    }

    /// The clips of the file, in its order.
    pub fn clips(&self) -> &[Clip] {
        &self.clips
    }

    /// The clip of that name; the first, if there is one, without a name.
    pub fn clip(&self, name: Option<&str>) -> Result<Option<usize>, Error> {
        let Some(name) = name else {
            return Ok((!self.clips.is_empty()).then_some(0));
        };
        let found = self.clips.iter().position(|clip| clip.name.as_deref() == Some(name));
        match found {
            Some(clip) => Ok(Some(clip)),
            None => Err(Error::NoClip {
                name: name.to_owned(),
                clips: self.clips.iter().filter_map(|clip| clip.name.clone()).collect(),
            }),
        }
    }

    /// What pictures are drawn with, in words.
    pub fn renderer(&self) -> &str {
        match &self.canvas {
            Canvas::Gpu(gpu) => &gpu.name,
            Canvas::Cpu => "built-in software renderer",
        }
    }

    /// What is not drawn or was done otherwise than asked, a sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Width by height of the pictures that a camera of the file is meant for,
    /// where the file says so.
    pub fn aspect(&self, camera: &str) -> Result<Option<f64>, Error> {
        Ok(self.camera(camera)?.aspect())
    }

    /// The camera that a node's name or its own belongs to.
    fn camera(&self, name: &str) -> Result<&Camera, Error> {
        let called = |which: usize| {
            let is = |camera: &&Camera| camera.names[which].as_deref() == Some(name);
            self.model.cameras.iter().find(is)
        };
        let names = self.model.cameras.iter().filter_map(|camera| camera.names.iter().flatten().next());
        let unknown = || Error::NoCamera { name: name.to_owned(), cameras: names.cloned().collect() };
        called(0).or_else(|| called(1)).ok_or_else(unknown)
    }

    /// Draws a pose as a camera sees it, with what else stands in the world.
    pub(super) fn draw(
        &mut self,
        pose: &Pose,
        frame: &Frame,
        size: (u32, u32),
        extras: &[Part],
    ) -> Result<Layer, Error> {
        let placed = pose.placed(&self.model);
        let scene = Scene::new(&self.model.parts, &self.model.textures, placed, frame, size);
        let scene = scene.with(extras, frame);
        let Canvas::Gpu(gpu) = &mut self.canvas else {
            return Ok(cpu::draw(&scene));
        };
        match gpu.draw(&scene) {
            Err(error) if self.may_fall_back => {
                let layer = cpu::draw(&scene);
                self.notes.push(fallen_back(&error));
                self.canvas = Canvas::Cpu;
                Ok(layer)
            }
            drawn => drawn,
        }
    }

    /// Where everything stands at `t` seconds.
    pub(super) fn pose(&mut self, asset: &mut Asset, clip: Option<usize>, t: f64) -> Result<Pose, Error> {
        match clip.and_then(|clip| self.clips.get(clip)) {
            Some(clip) => Ok(Pose::at(&self.model, asset, clip, &mut self.player, t)?),
            None => Ok(Pose::rest(&self.model)),
        }
    }

    /// The view that holds all of some clips' motion, or the camera asked for.
    pub(super) fn view(
        &mut self,
        asset: &mut Asset,
        clips: &[Which],
        style: &Style,
        turntable: bool,
    ) -> Result<View, Error> {
        check(style.size)?;
        if let Some((of, turns, view)) = &self.found
            && (of.as_slice(), *turns, &view.style) == (clips, turntable, style)
        {
            return Ok(view.clone());
        }
        let camera = style.camera.as_deref().map(|name| self.camera(name).cloned()).transpose()?;
        let view = View::new(style, camera, turntable, |take| self.sweep(asset, clips, take))?;
        self.found = Some((clips.to_vec(), turntable, view.clone()));
        Ok(view)
    }

    /// Hands out the corners of all boxes at many moments of some clips.
    fn sweep(
        &mut self,
        asset: &mut Asset,
        clips: &[Which],
        take: &mut dyn FnMut(DVec3),
    ) -> Result<(), Error> {
        for &clip in clips {
            for t in moments(self.duration(clip)) {
                let pose = self.pose(asset, clip, t)?;
                pose.corners(&self.model).for_each(&mut *take);
            }
        }
        Ok(())
    }

    /// How long a clip is, seconds; 0 without a clip.
    pub(super) fn duration(&self, clip: Option<usize>) -> f64 {
        let duration = clip.and_then(|clip| self.clips.get(clip)).map_or(0.0, |c| c.duration);
        if duration.is_finite() { duration } else { 0.0 }
    }
}

/// The ends of a clip and moments between them.
fn moments(duration: f64) -> Vec<f64> {
    match duration > 0.0 {
        true => (0..=FRAMING_MOMENTS)
            .map(|i| duration * (f64::from(i) * GOLDEN).fract())
            .chain([duration])
            .collect(),
        false => vec![0.0],
    }
}

/// The view that points fill.
pub(super) fn close_up(points: impl IntoIterator<Item = DVec3>, size: (u32, u32)) -> Result<Frame, Error> {
    check(size)?;
    let mut framing = Framing::new(size);
    points.into_iter().for_each(|point| framing.add(point));
    Ok(framing.frame())
}

fn gpu(model: &Model) -> Result<Canvas, Error> {
    Ok(Canvas::Gpu(Box::new(Gpu::new(&model.parts, &model.textures)?)))
}

/// One line, though errors may have several.
fn fallen_back(error: &Error) -> String {
    let reason = match error {
        Error::NoAdapter { reason } => format!("no graphics adapter ({reason})"),
        other => other.to_string(),
    };
    let words: Vec<&str> = reason.split_whitespace().collect();
    format!("drawn by the built-in software renderer: {}", words.join(" "))
}

fn check((width, height): (u32, u32)) -> Result<(), Error> {
    let fits = |side| (1..=MOST_PIXELS).contains(&side);
    match fits(width) && fits(height) {
        true => Ok(()),
        false => Err(Error::Size(width, height)),
    }
}
