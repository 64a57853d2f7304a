//! An SVG as PNG, with the letters of DejaVu Sans.

use super::Error;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};
use std::sync::Arc;

/// Draws an SVG of [`super::svg()`] at its own size, a pixel for each of its units.
pub fn png(svg: &str) -> Result<Vec<u8>, Error> {
    let problem = |error: String| Error::Png(error);
    let tree = tree(svg)?;
    let size = tree.size().to_int_size();
    let too_large = || problem(format!("{}x{} pixels are too many", size.width(), size.height()));
    let mut picture = Pixmap::new(size.width(), size.height()).ok_or_else(too_large)?;
    resvg::render(&tree, Transform::identity(), &mut picture.as_mut());
    picture.encode_png().map_err(|error| problem(error.to_string()))
}

/// The SVG with its words as outlines.
fn tree(svg: &str) -> Result<Tree, Error> {
    let mut fonts = Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options =
        Options { fontdb: Arc::new(fonts), font_family: "DejaVu Sans".to_owned(), ..Options::default() };
    Tree::from_str(svg, &options).map_err(|error| Error::Png(error.to_string()))
}
