//! The stages in a row: inputs in, a glTF file out.
//!
//! A [`Plan`] knows everything about the output but the samples: what will be warned
//! about, and how large it becomes. Writing it streams; memory holds the keys.

mod chosen;
mod corners;
mod error;
mod facts;
mod fewest;
mod layout;
mod recipe;
mod scene;
mod together;

pub use error::Error;
pub use facts::{CameraFacts, ClipFacts};
pub use fewest::Fewest;

use crate::clip::{Clip, Through, Warning};
use crate::curve::{self, Motion, Scheme};
use crate::moves::{Ground, Move, Mover};
use crate::path::{Kind, PathEnds};
use crate::read::Order;
use crate::sample::{self, Fps, Timeline, TooFine, Writing};
use crate::write::{Animation, Bin, Buffer, Colour, Glb, LARGEST_GLB, Scene, document, glb_size};
use chosen::Chosen;
use facts::{Found, Late};
use fewest::Unkept;
use layout::Layout;
use recipe::recipe;
use std::io::{self, Seek, Write};

/// How motion becomes animations.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the animations; with several schemes each adds its own.
    pub name: String,
    /// The inputs' names as the file keeps them: keyframes, then path, then cameras'.
    pub inputs: Vec<String>,
    /// The order of a quaternion's parts that was asked for, whatever headers say.
    pub quat_order: Option<Order>,
    /// What was asked of each camera, as the file keeps it.
    pub cameras: Vec<String>,
    /// How the path is drawn, if it is.
    pub path_colour: Option<Colour>,
    /// One animation a scheme.
    pub schemes: Vec<Scheme>,
    /// When samples are taken.
    pub sampling: Sampling,
    /// What numbers stand for rotations, and whether to find out how far playback is off.
    pub writing: Writing,
}

/// When samples are taken.
#[derive(Clone, Copy, Debug)]
pub enum Sampling {
    /// At a rate.
    Rate {
        /// Samples per second.
        fps: Fps,
        /// Whether every key time is a sample too.
        key_times: bool,
    },
    /// Wherever they are needed.
    Fewest(Fewest),
}

/// An output that is known but for its samples.
pub struct Plan<'a> {
    ground: &'a Ground<'a>,
    source_name: &'a str,
    options: &'a Options,
    scene: Scene,
    /// What each clip's nodes do, and when.
    clips: Vec<ClipPlan<'a>>,
    warnings: Vec<Warning>,
}

/// One clip: what every node does by a scheme, and when it is sampled.
struct ClipPlan<'a> {
    scheme: Scheme,
    object: Vec<(Mover, Move<'a>)>,
    /// What moves cameras, rotations first.
    cameras: Vec<(usize, Move<'a>)>,
    when: When<'a>,
}

/// When moves are sampled.
enum When<'a> {
    /// All of the object at the same times, and all cameras.
    Grid { object: Timeline<'a>, cameras: Option<Timeline<'a>> },
    /// Each move by keys of its own.
    Chosen { object: Vec<Chosen>, cameras: Vec<Chosen> },
}

impl<'a> ClipPlan<'a> {
    fn new(ground: &'a Ground<'a>, scheme: Scheme, options: &Options) -> Result<ClipPlan<'a>, Unsampled> {
        let (object, cameras) = (ground.moves(scheme), ground.camera_moves(scheme));
        sample::fits(ground.duration())?;
        // Whatever is asked for, what is held has its own keys.
        let held: Vec<&Motion> = object
            .iter()
            .filter_map(|(_, a_move)| match a_move {
                Move::Keys(motion) if motion.is_step() => Some(motion),
                _ => None,
            })
            .collect();
        held.iter().try_for_each(|motion| sample::keys_apart(motion.times()))?;
        let some_are_held = !held.is_empty();
        let by_tolerance = matches!(options.sampling, Sampling::Fewest(_));
        if ground.stream().count > 1 && (some_are_held || by_tolerance) {
            return Err(Unsampled::Copies(if by_tolerance { "--tolerance" } else { "--scheme step" }));
        }
        let when = match &options.sampling {
            &Sampling::Rate { fps, key_times } if some_are_held => {
                let timeline = ground.timeline(scheme, fps, key_times)?;
                let cameras_at = ground.camera_timeline(fps, key_times)?;
                When::Chosen {
                    object: chosen::held_and_sampled(&object, &timeline, options.writing),
                    cameras: match &cameras_at {
                        Some(timeline) => chosen::held_and_sampled(&cameras, timeline, options.writing),
                        None => Vec::new(),
                    },
                }
            }
            &Sampling::Rate { fps, key_times } => When::Grid {
                object: ground.timeline(scheme, fps, key_times)?,
                cameras: ground.camera_timeline(fps, key_times)?,
            },
            Sampling::Fewest(fewest) => {
                let encoding = options.writing.encoding;
                When::Chosen {
                    object: fewest::object(ground, &object, fewest, encoding)?,
                    cameras: fewest::cameras(ground, &cameras, fewest, encoding)?,
                }
            }
        };
        Ok(ClipPlan { scheme, object, cameras, when })
    }

    /// Samples of all of the object's moves together, and of the one that has the most.
    fn samples(&self) -> (u64, u64) {
        match &self.when {
            When::Grid { object, .. } => {
                let each = object.len() as u64;
                (each * self.object.len() as u64, each)
            }
            When::Chosen { object, .. } => {
                let counts = object.iter().map(|chosen| chosen.times.len() as u64);
                (counts.clone().sum(), counts.max().unwrap_or(0))
            }
        }
    }

    /// What was found out before anything is written.
    fn found(&self) -> Found {
        match &self.when {
            When::Grid { .. } => Found::default(),
            When::Chosen { object, cameras } => {
                Found { object: fewest::seen(object), cameras: fewest::seen(cameras), corners: None }
            }
        }
    }

    /// All figures that could be found out.
    fn every_figure(&self) -> Found {
        let paths = self.object.iter().filter(|(_, a_move)| a_move.travel().is_some()).count();
        Found::every(self.object.len() - paths, paths, self.cameras.len() / 2)
    }
}

/// Why a clip cannot be sampled.
enum Unsampled {
    TooFine(TooFine),
    Fewest(Unkept),
    /// Of what has keys of its own, by this flag.
    Copies(&'static str),
}

impl From<TooFine> for Unsampled {
    fn from(error: TooFine) -> Unsampled {
        Unsampled::TooFine(error)
    }
}

impl From<Unkept> for Unsampled {
    fn from(error: Unkept) -> Unsampled {
        Unsampled::Fewest(error)
    }
}

impl<'a> Plan<'a> {
    /// Plans the output of what was put together from `source_name`; `options.schemes` is
    /// not empty. Where no scheme makes a difference, there is one clip.
    pub fn new(
        ground: &'a Ground<'a>,
        source_name: &'a str,
        options: &'a Options,
    ) -> Result<Plan<'a>, Error> {
        let schemes = if ground.has_schemes() { &options.schemes[..] } else { &options.schemes[..1] };
        let scene = scene::scene(ground, options.path_colour);
        let clip = |&scheme: &Scheme| {
            ClipPlan::new(ground, scheme, options).map_err(|error| match error {
                Unsampled::TooFine(error) => too_fine(error, ground, source_name, scheme),
                Unsampled::Fewest(Unkept { error, unit, reserve, shared }) => {
                    Error::Fewest { source_name: source_name.to_owned(), error, unit, reserve, shared }
                }
                Unsampled::Copies(flag) => Error::Copies(source_name.to_owned(), flag),
            })
        };
        let clips = schemes.iter().map(clip).collect::<Result<_, _>>()?;
        let warnings = warnings(ground, options);
        Ok(Plan { ground, source_name, options, scene, clips, warnings })
    }

    /// What the user should know before a sample is made.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// How many rotations and places will be written.
    pub fn samples(&self) -> u64 {
        self.layout().samples()
    }

    /// Writes a .glb to `out`, which stands at its start. `progress` is told of every so
    /// many rotations and places.
    pub fn write_glb<W: Write + Seek>(
        &self,
        out: W,
        progress: impl FnMut(u64),
    ) -> io::Result<(W, Vec<ClipFacts>)> {
        let layout = self.layout();
        let mut glb = Glb::new(out, self.widest_json(&layout))?;
        let facts = self.samples_to(&layout, &mut glb, progress)?;
        let json = self.json(&layout, &facts, None);
        Ok((glb.finish(&json)?, facts))
    }

    /// Writes the .bin of a .gltf to `out` and returns the .gltf's JSON; `name` makes the
    /// .bin's file name, as the .gltf refers to it, of its content's hash.
    pub fn write_gltf<W: Write>(
        &self,
        out: W,
        name: impl FnOnce(&str) -> String,
        progress: impl FnMut(u64),
    ) -> io::Result<(W, Vec<u8>, Vec<ClipFacts>)> {
        let layout = self.layout();
        let mut bin = Bin::new(out);
        let facts = self.samples_to(&layout, &mut bin, progress)?;
        let (out, hash) = bin.finish()?;
        Ok((out, self.json(&layout, &facts, Some(name(&hash))), facts))
    }

    /// Refuses a plan whose .glb would be larger than a .glb can be.
    pub fn fits_glb(&self) -> Result<(), Error> {
        let layout = self.layout();
        let json = self.widest_json(&layout);
        let bytes = glb_size(json, layout.length);
        if bytes <= LARGEST_GLB {
            return Ok(());
        }
        // What is not a scene's grows with the number of samples.
        let still = self.scene.bytes().len() as u64;
        let longest = self.clips.iter().map(|clip| clip.samples().1).max().unwrap_or(1);
        let sample = (layout.length - still) as f64 / longest as f64;
        let samples = (LARGEST_GLB - glb_size(json, still)) as f64 / sample;
        let rate = |others: usize| Fps::at_most((samples - others as f64) / self.ground.duration());
        // Both ends, and the start of a ramp.
        let key_times_asked = matches!(self.options.sampling, Sampling::Rate { key_times: true, .. });
        let with_keys = rate(self.ground.knots().len() + 3).filter(|_| key_times_asked);
        let source_name = self.source_name.to_owned();
        let largest_fps = with_keys.or_else(|| rate(3));
        let key_times = with_keys.is_some() || !key_times_asked;
        let several_schemes = self.clips.len() > 1;
        Err(Error::TooLarge { source_name, bytes, largest_fps, key_times, several_schemes })
    }

    fn layout(&self) -> Layout<'_> {
        Layout::new(&self.scene, &self.clips, self.ground.stream(), self.options.writing)
    }

    /// An upper bound of the JSON's length: that of a document whose figures all take the
    /// most digits.
    fn widest_json(&self, layout: &Layout) -> usize {
        let widest =
            |(clip, plan): (usize, &ClipPlan)| self.facts(clip, layout, plan.every_figure()).widest();
        let facts: Vec<ClipFacts> = self.clips.iter().enumerate().map(widest).collect();
        let uri = "0".repeat(64);
        self.json(layout, &facts, Some(uri)).len()
    }

    fn json(&self, layout: &Layout, facts: &[ClipFacts], uri: Option<String>) -> Vec<u8> {
        let animation = |(clip, facts): (usize, &ClipFacts)| {
            let extras = recipe(self.ground, self.options, self.clips[clip].scheme, facts);
            Animation { name: facts.name.clone(), extras, channels: layout.channels[clip].clone() }
        };
        let animations: Vec<Animation> = facts.iter().enumerate().map(animation).collect();
        document(&self.scene, &animations, layout.length, uri)
    }

    fn samples_to(
        &self,
        layout: &Layout,
        buffer: &mut impl Buffer,
        mut progress: impl FnMut(u64),
    ) -> io::Result<Vec<ClipFacts>> {
        buffer.append(&self.scene.bytes())?;
        let mut found: Vec<Found> = self.clips.iter().map(ClipPlan::found).collect();
        for block in &layout.blocks {
            block.write(self.options.writing, buffer, &mut progress, &mut found)?;
        }
        if self.options.writing.bound {
            for (found, plan) in found.iter_mut().zip(&self.clips) {
                found.corners = corners::displacement(self.ground, plan, self.options.writing);
            }
        }
        let facts = found.into_iter().enumerate();
        Ok(facts.map(|(clip, found)| self.facts(clip, layout, found)).collect())
    }

    /// An upper bound of how far a corner of the chain can be from where it should be: the
    /// smaller of what was found and of what the rotations are off, each of which turns all
    /// that hangs below.
    fn displacement(
        &self,
        plan: &ClipPlan,
        facts: &ClipFacts,
        corners: Option<f64>,
        late: &Late,
    ) -> Option<f64> {
        self.ground.chain_length()?;
        let turns = || plan.object.iter().filter(|(_, a_move)| a_move.rotation().is_some());
        let reach = |(mover, _): &(Mover, Move)| self.ground.reach_below(*mover);
        let sum = |degrees: &mut dyn Iterator<Item = Option<f64>>| -> Option<f64> {
            turns().zip(degrees).map(|(turn, degrees)| degrees.map(|x| x.to_radians() * reach(turn))).sum()
        };
        let seen =
            corners.and_then(|corners| Some(corners + sum(&mut late.degrees.iter().copied())? + late.units));
        let turned = sum(&mut facts.tracks.iter().map(|track| track.deviation));
        let summed = turned.map(|turned| turned + facts.deviation_units.unwrap_or(0.0));
        let off = seen.into_iter().chain(summed).reduce(f64::min)?;
        (!facts.tracks.is_empty()).then(|| facts::rounded_up(off))
    }

    fn facts(&self, clip: usize, layout: &Layout, found: Found) -> ClipFacts {
        let plan = &self.clips[clip];
        let name = match self.clips.as_slice() {
            [_] => self.options.name.clone(),
            _ => format!("{}-{}", self.options.name, plan.scheme.name()),
        };
        let turned = &plan.cameras[..plan.cameras.len() / 2];
        let node = |camera: usize| &self.scene.nodes[self.scene.cameras[camera]];
        let cameras = turned.iter().map(|&(camera, _)| node(camera).name.clone()).collect();
        let (corners, late) = (found.corners, layout.lateness(&plan.object));
        let found = found.late(&late);
        let facts = ClipFacts::new(name, plan.scheme.name(), plan.samples(), found, cameras);
        ClipFacts { displacement_units: self.displacement(plan, &facts, corners, &late), ..facts }
    }
}

fn too_fine(error: TooFine, ground: &Ground, source_name: &str, scheme: Scheme) -> Error {
    let source_name = source_name.to_owned();
    match (error, &ground.inputs().keyframes, &ground.inputs().path) {
        (TooFine::Keys { key }, Some(keyframes), None) => {
            let clip = &keyframes.clip;
            let lines = (clip.line(key), clip.line(key + 1));
            let key_times = clip.duration() as f32 > 0.0 && !scheme.is_step();
            Error::KeysTooClose { source_name, lines, seconds: clip.times[key], key_times }
        }
        (other, ..) => Error::TooFine(source_name, other),
    }
}

fn warnings(ground: &Ground, options: &Options) -> Vec<Warning> {
    let inputs = ground.inputs();
    let mut warnings = Vec::new();
    if let Some(keyframes) = &inputs.keyframes {
        warnings.extend_from_slice(&keyframes.warnings);
        warnings.extend(close_keys(&keyframes.clip, options));
        let clip = &keyframes.clip;
        if clip.through == Through::Keys {
            let place = |key| clip.place(key);
            let ends = ground.shape().ends;
            let by = |&scheme| curve::warnings(&clip.times, &clip.tracks, &place, scheme, ends);
            warnings.extend(options.schemes.iter().flat_map(by));
        }
    }
    if let Some((times, keys, ends)) = ground.orientation_keys() {
        let place = |key: usize| format!("t = {:.6} s (key point {})", times[key], key + 1);
        let by = |&scheme| curve::warnings(times, &[keys], &place, scheme, ends);
        warnings.extend(options.schemes.iter().flat_map(by));
    }
    warnings.extend(inputs.path.iter().flat_map(|path| path.warnings.iter().cloned()));
    warnings.extend(inputs.path.as_ref().and_then(|path| idle_ends(path.kind, ground.shape().path_ends)));
    warnings.dedup();
    warnings
}

/// Ends that a path of this kind does not have.
fn idle_ends(kind: Kind, ends: PathEnds) -> Option<Warning> {
    let through = matches!(kind, Kind::CatmullRom | Kind::CatmullRomCentripetal | Kind::CatmullRomChordal);
    let idle = !through && matches!(ends, PathEnds::Clamped | PathEnds::Repeat);
    idle.then(|| {
        let (kind, ends) = (kind.name(), ends.name());
        let message = format!("--path-ends {ends} changes nothing: only catmull-rom paths have ends to shape, a {kind} path is what its points say");
        Warning::new("IDLE_ENDS", message)
    })
}

/// Keys so close that some viewers merge them.
fn close_keys(clip: &Clip, options: &Options) -> Option<Warning> {
    const APART: f64 = 1e-3;
    let gap = |i: usize| clip.times[i + 1] - clip.times[i];
    let close = || (0..clip.times.len() - 1).filter(|&i| gap(i) < APART * (1.0 - 1e-9));
    let key_times = matches!(options.sampling, Sampling::Rate { key_times: true, .. });
    let count = if key_times { close().count() } else { 0 };
    let worst = close().min_by(|&a, &b| gap(a).total_cmp(&gap(b)))?;
    (count > 0).then(|| {
        let message = format!(
            "{count} key{} less than 1 ms after the one before, the closest {:.3} ms at {}; Blender merges keys \
             closer than 0.42 ms",
            if count == 1 { " comes" } else { "s come" },
            1e3 * gap(worst),
            clip.place(worst + 1)
        );
        Warning::new("CLOSE_KEYS", message)
    })
}
