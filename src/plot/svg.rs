//! A figure as SVG, in which words stay words.

use super::figure::{Entry, Figure, Panel, Sign};
use super::layout::{self, Area, EDGE, HEADING, LABEL, LEGEND, Page, RAMP, SIGN_GAP, TICK, TITLE};
use super::paint::{Brush, MARK, Map};
use super::style::{Ink, Theme};
use super::ticks::{Numbers, step};
use super::{Error, Stroke};
use kuva::backend::svg::SvgBackend;
use kuva::render::axis::{add_axes_and_grid, add_labels_and_title};
use kuva::render::layout::{ComputedLayout, Layout, TickFormat};
use kuva::render::render::{Primitive, Scene, TextAnchor};
use std::sync::Arc;

/// Fonts in the order of preference; the first is the one that words were measured by.
const FONTS: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

/// Above a panel's axes, for its title.
const ABOVE: f64 = 36.0;

/// The least room right of axes, where half of the last tick's number stands.
const RIGHT: f64 = 22.0;

/// Draws a figure, of a size in pixels or as large as its panels like to be.
pub fn svg(figure: &Figure, theme: Theme, size: Option<(u32, u32)>) -> Result<String, Error> {
    let page = layout::page(figure, size)?;
    let mut brush = Brush::new(theme, scene(&page, theme));
    header(&mut brush, figure, &page);
    let sides = margins(figure, &page, theme);
    let scale = common_scale(figure, &page, sides, theme);
    for (number, (panel, area)) in figure.panels.iter().zip(&page.cells).enumerate() {
        brush.open(area.x, area.y);
        draw_panel(&mut brush, panel, area, sides, scale, number);
        brush.close();
    }
    Ok(SvgBackend::new().render_scene(&brush.scene))
}

fn scene(page: &Page, theme: Theme) -> Scene {
    let mut scene = Scene::new(page.width, page.height);
    scene.background_color = Some(hex(theme.background()));
    scene.text_color = Some(hex(theme.colour(Ink::Words)));
    scene.font_family = Some(FONTS.to_owned());
    scene
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Title, legend and the strip of colours.
fn header(brush: &mut Brush, figure: &Figure, page: &Page) {
    let (title, size) = layout::fitted(&figure.title, TITLE, page.width - 2.0 * EDGE);
    brush.text(EDGE, EDGE + 0.8 * f64::from(TITLE), &title, size, TextAnchor::Start, true);
    for (entry, &[x, y]) in figure.legend.iter().zip(&page.entries) {
        sign(brush, entry, x, y);
        let baseline = y + 0.36 * f64::from(LEGEND);
        brush.text(
            x + layout::sign(entry) + SIGN_GAP,
            baseline,
            &entry.label,
            LEGEND,
            TextAnchor::Start,
            false,
        );
    }
    if let (Some([from, to]), Some([x, y])) = (&figure.ramp, page.ramp) {
        strip(brush, x, y, from, to);
    }
}

fn sign(brush: &mut Brush, entry: &Entry, x: f64, y: f64) {
    let wide = layout::sign(entry);
    match &entry.sign {
        Sign::Line(stroke) => brush.segment([x, y], [x + wide, y], stroke),
        Sign::Dot(dot) => brush.dot(x + 0.5 * wide, y, *dot, 4.2),
        Sign::Mark => {
            let x = x + 0.5 * wide;
            brush.segment([x, y - 9.0], [x, y + 9.0], &MARK);
        }
    }
}

/// The colours from the first to the last time.
fn strip(brush: &mut Brush, x: f64, y: f64, from: &str, to: &str) {
    let (steps, baseline) = (50, y + 0.36 * f64::from(LEGEND));
    let start = x + layout::width(from, LEGEND) + SIGN_GAP;
    brush.text(start - SIGN_GAP, baseline, from, LEGEND, TextAnchor::End, false);
    for i in 0..steps {
        // Each to the strip's end, and the next above it, lest the background shine through.
        let share = f64::from(i) / f64::from(steps);
        brush.segment([start + share * RAMP, y], [start + RAMP, y], &Stroke::solid(Ink::Time(share), 10.0));
    }
    brush.text(start + RAMP + SIGN_GAP, baseline, to, LEGEND, TextAnchor::Start, false);
}

/// The axes of a panel in its place.
fn axes(panel: &Panel, area: &Area, [left, right]: [f64; 2], theme: Theme) -> Layout {
    let [x, y] = [panel.x.range, panel.y.range];
    let plot = [area.width - left - right, area.height - ABOVE - 60.0];
    // On axes of one scale the same step both ways.
    let every = if panel.equal { [70.0, 70.0] } else { [100.0, 55.0] };
    let steps = [step(x, plot[0], every[0], true), step(y, plot[1], every[1], false)];
    let ticks = |step: f64, range: [f64; 2]| {
        let numbers = Numbers::new(step, range);
        TickFormat::Custom(Arc::new(move |value| numbers.write(value)))
    };
    let mut layout = Layout::new((x[0], x[1]), (y[0], y[1]))
        .with_width(area.width)
        .with_height(area.height)
        .with_x_axis_min(x[0])
        .with_x_axis_max(x[1])
        .with_y_axis_min(y[0])
        .with_y_axis_max(y[1])
        .with_x_tick_step(steps[0])
        .with_y_tick_step(steps[1])
        .with_x_tick_format(ticks(steps[0], x))
        .with_y_tick_format(ticks(steps[1], y))
        .with_tick_size(TICK)
        .with_label_size(LABEL)
        .with_theme(chrome(theme));
    layout.x_label = panel.x.label.clone();
    layout.y_label = panel.y.label.clone();
    layout
}

fn chrome(theme: Theme) -> kuva::render::theme::Theme {
    let (words, quiet, grid) =
        (hex(theme.colour(Ink::Words)), hex(theme.colour(Ink::Quiet)), hex(theme.colour(Ink::Grid)));
    kuva::render::theme::Theme {
        background: hex(theme.background()),
        axis_color: quiet.clone(),
        tick_color: quiet,
        grid_color: grid,
        text_color: words,
        ..kuva::render::theme::Theme::light()
    }
}

fn has_axes(panel: &Panel) -> bool {
    panel.x.label.is_some() || panel.y.label.is_some()
}

/// Left and right of all axes: what the widest ticks need, so that panels line up.
fn margins(figure: &Figure, page: &Page, theme: Theme) -> [f64; 2] {
    let with_axes = figure.panels.iter().zip(&page.cells).filter(|(panel, _)| has_axes(panel));
    let narrowest = page.cells.iter().map(|cell| cell.width).fold(f64::INFINITY, f64::min);
    let wanted = with_axes.fold([0.0, RIGHT], |[left, right]: [f64; 2], (panel, area)| {
        let free = ComputedLayout::from_layout(&axes(panel, area, [80.0, RIGHT], theme));
        [left.max(free.margin_left), right.max(free.margin_right)]
    });
    // Numbers with very many digits must leave room for what they are about.
    wanted.map(|side| side.min(0.4 * narrowest))
}

fn computed(panel: &Panel, area: &Area, sides: [f64; 2], theme: Theme) -> (Layout, ComputedLayout) {
    let layout = axes(panel, area, sides, theme);
    let below = ComputedLayout::from_layout(&layout).margin_bottom;
    let layout = layout.with_force_margins(sides[0], sides[1]).with_force_margins_y(ABOVE, below);
    let computed = ComputedLayout::from_layout(&layout);
    (layout, computed)
}

/// Pixels a unit in panels whose axes have one scale: the largest that fits all of them.
fn common_scale(figure: &Figure, page: &Page, sides: [f64; 2], theme: Theme) -> f64 {
    let equal = figure.panels.iter().zip(&page.cells).filter(|(panel, _)| panel.equal);
    let scale = |(panel, area): (&Panel, &Area)| {
        let (_, computed) = computed(panel, area, sides, theme);
        let [x, y] = [&panel.x, &panel.y].map(|axis| axis.range[1] - axis.range[0]);
        (computed.plot_width() / x).min(computed.plot_height() / y)
    };
    equal.map(scale).fold(f64::INFINITY, f64::min)
}

/// The panel with its ranges widened to the common scale.
fn widened(panel: &Panel, computed: &ComputedLayout, scale: f64) -> Panel {
    let mut panel = panel.clone();
    let pixels = [computed.plot_width(), computed.plot_height()];
    for (axis, pixels) in [&mut panel.x, &mut panel.y].into_iter().zip(pixels) {
        let (middle, half) = (0.5 * (axis.range[0] + axis.range[1]), 0.5 * pixels / scale);
        axis.range = [middle - half, middle + half];
    }
    panel
}

fn draw_panel(brush: &mut Brush, panel: &Panel, area: &Area, sides: [f64; 2], scale: f64, number: usize) {
    if !has_axes(panel) {
        return draw_bare(brush, panel, area, sides[0].max(EDGE), number);
    }
    let (_, first) = computed(panel, area, sides, brush.theme);
    let widened = if panel.equal { widened(panel, &first, scale) } else { panel.clone() };
    let (layout, computed) = computed(&widened, area, sides, brush.theme);
    add_axes_and_grid(&mut brush.scene, &computed, &layout);
    add_labels_and_title(&mut brush.scene, &computed, &layout);
    let [width, height] = [computed.plot_width(), computed.plot_height()];
    let (x, y) = (computed.margin_left, computed.margin_top);
    title(brush, panel, x, area.width - x);
    let map = Map::new(&widened, Area { x, y, width, height });
    brush.layers(&widened.layers, &map, number);
}

/// A drawing without axes: both ways at one scale, in the middle of its place.
fn draw_bare(brush: &mut Brush, panel: &Panel, area: &Area, left: f64, number: usize) {
    title(brush, panel, left, area.width - left);
    let [x, y] = [&panel.x, &panel.y].map(|axis| axis.range[1] - axis.range[0]);
    let scale = ((area.width - EDGE) / x).min((area.height - ABOVE) / y);
    let (width, height) = (scale * x, scale * y);
    let place = Area {
        x: 0.5 * (area.width - width),
        y: ABOVE + 0.5 * (area.height - ABOVE - height),
        width,
        height,
    };
    brush.layers(&panel.layers, &Map::new(panel, place), number);
}

fn title(brush: &mut Brush, panel: &Panel, x: f64, room: f64) {
    let (title, size) = layout::fitted(&panel.title, HEADING, room);
    brush.text(x, ABOVE - 11.0, &title, size, TextAnchor::Start, false);
}

impl Brush {
    /// Begins a group whose left upper corner is the origin.
    fn open(&mut self, x: f64, y: f64) {
        let transform = Some(format!("translate({x:.2},{y:.2})"));
        self.scene.add(Primitive::GroupStart {
            transform,
            title: None,
            extra_attrs: Some("class=\"panel\"".into()),
        });
    }

    fn close(&mut self) {
        self.scene.add(Primitive::GroupEnd);
    }
}
