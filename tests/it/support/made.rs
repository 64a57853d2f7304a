//! Text to a file in memory, through the library alone, and the file as another crate
//! reads it.

use dat2glb::asset::{Asset, NoFiles};
use dat2glb::check::{self, Report};
use dat2glb::convert::{ClipFacts, Options, Plan, Sampling};
use dat2glb::curve::Scheme;
use dat2glb::moves::{Ground, Inputs, Shape, rotation_keys};
use dat2glb::read::{self, Input};
use dat2glb::sample::Writing;
use gltf::animation::Interpolation;
use gltf::animation::util::ReadOutputs;
use std::io::Cursor;

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    pub(crate) scheme: Scheme,
    pub(crate) shape: Shape,
    pub(crate) sampling: Sampling,
    pub(crate) writing: Writing,
}

/// A file, and what its making said of it.
pub(crate) struct Made {
    pub(crate) file: Vec<u8>,
    pub(crate) facts: Vec<ClipFacts>,
}

/// What a text holds.
pub(crate) fn inputs(text: &str) -> Result<Inputs, String> {
    let input = read::input("made.dat", text.as_bytes(), None).map_err(|error| error.to_string())?;
    let (keyframes, path) = match input {
        Input::Keyframes(keyframes) => (Some(keyframes), None),
        Input::Rotations(file) => (Some(rotation_keys(file, None)), None),
        Input::Path(file) => (None, Some(file)),
        _ => unreachable!("an input of a new kind"),
    };
    Ok(Inputs { keyframes, path, cameras: Vec::new() })
}

/// The file of some inputs, or the words that refuse them.
pub(crate) fn made(inputs: &Inputs, asked: Asked) -> Result<Made, String> {
    let options = Options {
        name: "made".into(),
        inputs: vec!["made.dat".into()],
        quat_order: None,
        cameras: Vec::new(),
        path_colour: None,
        schemes: vec![asked.scheme],
        sampling: asked.sampling,
        writing: asked.writing,
    };
    let ground = Ground::new(inputs, asked.shape, &options.schemes).map_err(|error| error.to_string())?;
    let plan = Plan::new(&ground, "made.dat", &options).map_err(|error| error.to_string())?;
    plan.fits_glb().map_err(|error| error.to_string())?;
    let (file, facts) = plan.write_glb(Cursor::new(Vec::new()), |_| ()).unwrap();
    Ok(Made { file: file.into_inner(), facts })
}

impl Made {
    pub(crate) fn asset(&self) -> Asset {
        Asset::open(Box::new(Cursor::new(self.file.clone())), Box::new(NoFiles)).unwrap()
    }

    /// What `check` says.
    pub(crate) fn report(&self) -> Report {
        check::asset(&mut self.asset())
    }

    /// The channels of the first animation.
    pub(crate) fn channels(&self) -> Vec<Channel> {
        let file = gltf::Gltf::from_slice(&self.file).unwrap();
        let animation = file.animations().next().unwrap();
        let bin = |_: gltf::Buffer| file.blob.as_deref();
        animation
            .channels()
            .map(|channel| {
                let reader = channel.reader(bin);
                let values = match reader.read_outputs().unwrap() {
                    ReadOutputs::Rotations(rotations) => Values::Rotations(rotations.into_f32().collect()),
                    ReadOutputs::Translations(places) => Values::Translations(places.collect()),
                    _ => panic!("only rotations and translations are animated"),
                };
                Channel {
                    interpolation: channel.sampler().interpolation(),
                    times: reader.read_inputs().unwrap().collect(),
                    values,
                }
            })
            .collect()
    }
}

/// One node's rotation or place over time, as it is stored.
#[derive(Debug)]
pub(crate) struct Channel {
    pub(crate) interpolation: Interpolation,
    pub(crate) times: Vec<f32>,
    pub(crate) values: Values,
}

/// What a channel holds: of CUBICSPLINE a tangent before and after each value.
#[derive(Debug)]
pub(crate) enum Values {
    Rotations(Vec<[f32; 4]>),
    Translations(Vec<[f32; 3]>),
}

impl Channel {
    /// The value at each time, without tangents.
    pub(crate) fn rotations(&self) -> Vec<[f32; 4]> {
        match (&self.values, self.interpolation) {
            (Values::Rotations(all), Interpolation::CubicSpline) => {
                all.chunks_exact(3).map(|key| key[1]).collect()
            }
            (Values::Rotations(all), _) => all.clone(),
            (Values::Translations(_), _) => Vec::new(),
        }
    }
}
