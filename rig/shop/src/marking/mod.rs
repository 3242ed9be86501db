//! Landmarks set on a scan by hand while the rest is warped along (HEADSHOP 6.1): the model of `head landmarks`.
//!
//! A person points at pixels; this knows what lies under them. From three landmarks on all others are estimated, and
//! every further one betters the estimates, until the person has set or accepted what they want. Where the scan has no
//! data a landmark stays in mid-air at its estimated depth, and is moved in the plane of the view. There is no window
//! here and no clock: every deed is a method with plain numbers, so that tests do what hands do.
//!
//! - `camera`: orbit, pan, zoom, views
//! - `dots`: landmarks as they appear in the picture, and what pressing, dragging and releasing does
//! - `history`: undo and redo
//! - `names`: landmarks in words, and their order
//! - `store`: from and to landmark files
//! - `warnings`: what looks wrong

mod camera;
mod dots;
mod history;
pub mod names;
mod store;
mod warnings;

use glam::{Quat, Vec2, Vec3};

pub use camera::{Camera, View};
pub use dots::{Dot, Placed};
pub use warnings::Warning;

use crate::closest::{Facing, Surface};
use crate::fit::align::Similarity;
use crate::fit::estimate::{Estimate, Source, estimate};
use crate::landmarks::Unit;
use crate::mesh::ReferencePoint;
use dots::Drag;
use history::History;

/// Landmarks from which the others are estimated: HEADSHOP 6.1.
pub const ENOUGH: usize = 3;

/// Points of which the widest is farther from the line through two others than this share of the line are no line.
const LINE: f32 = 0.1;

/// Where a landmark stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Nobody knows yet.
    Unknown,
    /// Warped along with those that are set, on the scan's surface.
    Estimated,
    /// Warped along, where the scan has no surface.
    MidAir,
    /// Set or accepted by hand.
    Set,
}

/// A scan on which landmarks are being set.
pub struct Marking {
    scan: Surface,
    reference: Vec<ReferencePoint>,
    /// By what to place first.
    set: Vec<Option<Vec3>>,
    estimates: Option<Vec<Estimate>>,
    /// From the reference head to the scan.
    similarity: Option<Similarity>,
    warnings: Vec<Warning>,
    selected: usize,
    history: History,
    saved: Vec<Option<Vec3>>,
    drag: Option<Drag>,
    unit: Option<Unit>,
    /// Where the scan is looked at from.
    pub camera: Camera,
}

impl Marking {
    /// Nothing set yet. `reference` is [`landmarks_of`](crate::refit::landmarks_of) a head, `unit` the scan's, where
    /// somebody said it. None if there are no landmarks to set.
    #[must_use]
    pub fn new(
        scan: Surface,
        mut reference: Vec<ReferencePoint>,
        unit: Option<Unit>,
    ) -> Option<Self> {
        if reference.is_empty() {
            return None;
        }
        reference.sort_by_key(|r| names::rank(&r.name));
        let count = reference.len();
        Some(Self {
            camera: Camera::at(scan.positions()),
            scan,
            reference,
            set: vec![None; count],
            estimates: None,
            similarity: None,
            warnings: Vec::new(),
            selected: 0,
            history: History::default(),
            saved: vec![None; count],
            drag: None,
            unit,
        })
    }

    /// The scan.
    #[must_use]
    pub fn scan(&self) -> &Surface {
        &self.scan
    }

    /// The reference head's landmarks in the order of this model's numbers.
    #[must_use]
    pub fn reference(&self) -> &[ReferencePoint] {
        &self.reference
    }

    /// The name of a landmark; empty beyond the last.
    #[must_use]
    pub fn name(&self, landmark: usize) -> &str {
        self.reference.get(landmark).map_or("", |r| &r.name)
    }

    /// The number of the landmark of that name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<usize> {
        self.reference.iter().position(|r| r.name == name)
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.reference.len()
    }

    /// How many are set by hand.
    #[must_use]
    pub fn set_count(&self) -> usize {
        self.set.iter().flatten().count()
    }

    /// Where a landmark stands.
    #[must_use]
    pub fn state(&self, landmark: usize) -> State {
        if self.set.get(landmark).copied().flatten().is_some() {
            return State::Set;
        }
        match self.estimate(landmark) {
            Some(estimate) if estimate.on_scan => State::Estimated,
            Some(_) => State::MidAir,
            None => State::Unknown,
        }
    }

    /// Where a landmark is, set or estimated.
    #[must_use]
    pub fn place(&self, landmark: usize) -> Option<Vec3> {
        let set = self.set.get(landmark).copied().flatten();
        set.or_else(|| Some(self.estimate(landmark)?.at))
    }

    fn estimate(&self, landmark: usize) -> Option<&Estimate> {
        self.estimates.as_ref()?.get(landmark)
    }

    /// The landmark that clicks place.
    #[must_use]
    pub fn selected(&self) -> usize {
        self.selected
    }

    /// Makes clicks place this one.
    pub fn select(&mut self, landmark: usize) {
        self.selected = landmark.min(self.count() - 1);
    }

    /// Selects the next landmark that is not set, round the end; false if all are.
    pub fn next_unset(&mut self) -> bool {
        let count = self.count();
        let next = (1..=count)
            .map(|step| (self.selected + step) % count)
            .find(|i| self.set[*i].is_none());
        self.selected = next.unwrap_or(self.selected);
        next.is_some()
    }

    /// Sets a landmark to a point of the scan's frame.
    pub fn set(&mut self, landmark: usize, at: Vec3) {
        if landmark < self.count() && at.is_finite() {
            self.remember();
            self.set[landmark] = Some(at);
            self.renew();
        }
    }

    /// Takes back what was set, so that the landmark is estimated again.
    pub fn clear(&mut self, landmark: usize) {
        if self.set.get(landmark).is_some_and(Option::is_some) {
            self.remember();
            self.set[landmark] = None;
            self.renew();
        }
    }

    /// Sets a landmark to where it is estimated; false if it is not.
    pub fn accept(&mut self, landmark: usize) -> bool {
        let estimate = match self.state(landmark) {
            State::Estimated | State::MidAir => self.place(landmark),
            State::Unknown | State::Set => None,
        };
        if let Some(at) = estimate {
            self.set(landmark, at);
        }
        estimate.is_some()
    }

    /// Exchanges the sides of everything that has one.
    pub fn exchange_sides(&mut self) {
        self.remember();
        let before = self.set.clone();
        for (i, at) in before.into_iter().enumerate() {
            let other = names::opposite(self.name(i)).and_then(|n| self.find(&n));
            self.set[other.unwrap_or(i)] = at;
        }
        self.renew();
    }

    /// Exchanges two landmarks.
    pub fn exchange(&mut self, one: usize, other: usize) {
        if one.max(other) < self.count() {
            self.remember();
            self.set.swap(one, other);
            self.renew();
        }
    }

    /// Takes back the last deed; false if there is none.
    pub fn undo(&mut self) -> bool {
        self.drag = None;
        let done = self.history.undo(&mut self.set);
        self.renew();
        done
    }

    /// Does again what was taken back; false if there is nothing.
    pub fn redo(&mut self) -> bool {
        self.drag = None;
        let done = self.history.redo(&mut self.set);
        self.renew();
        done
    }

    /// What looks wrong, the worst first.
    #[must_use]
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// A warning as a sentence.
    #[must_use]
    pub fn words(&self, warning: &Warning) -> String {
        warning.words(&self.names())
    }

    /// Looks from there: in the head's frame as soon as that is known, else in the scan's.
    pub fn look(&mut self, view: View) {
        let head = self.similarity.map_or(Quat::IDENTITY, |s| s.rotation);
        self.camera.look(view, head);
    }

    /// Turns the head upright in the picture by quarters, for scans that lie on their side; `turns` against the clock.
    pub fn quarter_turn(&mut self, turns: i8) {
        self.camera
            .roll(f32::from(turns) * std::f32::consts::FRAC_PI_2);
    }

    /// Goes nearer to what is under the pixel, or away from it.
    pub fn zoom(&mut self, factor: f32, at: Vec2, size: Vec2) {
        let point = self.pick(at, size).unwrap_or(self.camera.target);
        self.camera.zoom(factor, at, size, point);
    }

    /// Before the view is turned: chooses what to turn about.
    pub fn begin_turn(&mut self, size: Vec2) {
        let seen = self.pick(size / 2.0, size);
        self.camera.pivot(seen);
    }

    /// What is under the pixel.
    #[must_use]
    pub fn pick(&self, at: Vec2, size: Vec2) -> Option<Vec3> {
        let (eye, way) = self.camera.ray(at, size);
        let hit = self.scan.ray(eye, way, f32::MAX, Facing::ANY)?;
        Some(hit.point)
    }

    fn names(&self) -> Vec<&str> {
        self.reference.iter().map(|r| r.name.as_str()).collect()
    }

    fn remember(&mut self) {
        self.history.push(&self.set);
    }

    /// Estimates and judges anew.
    fn renew(&mut self) {
        self.estimates = None;
        self.similarity = None;
        self.warnings.clear();
        self.camera.up = None;
        let sources = self.sources();
        let (from, to): (Vec<Vec3>, Vec<Vec3>) = sources
            .iter()
            .filter_map(|s| Some((s.at, s.known?)))
            .unzip();
        if from.len() < ENOUGH {
            return;
        }
        if on_a_line(&from) || on_a_line(&to) {
            self.warnings = vec![Warning::Line];
            return;
        }
        self.similarity = Similarity::between(&from, &to);
        self.camera.up = self.similarity.map(|s| s.rotation * Vec3::Y);
        self.estimates = estimate(&sources, &self.scan).ok();
        // While a point is being dragged nobody reads warnings, and they cost more than the rest.
        if self.drag.is_none() {
            self.warnings = warnings::find(&self.names(), &sources, &self.scan);
        }
    }

    fn sources(&self) -> Vec<Source> {
        self.reference
            .iter()
            .zip(&self.set)
            .map(|(r, known)| Source {
                at: r.at,
                normal: r.normal,
                known: *known,
            })
            .collect()
    }
}

/// Whether points lie on one line (or spot), and so do not say how a head is turned about it.
fn on_a_line(points: &[Vec3]) -> bool {
    let Some(&first) = points.first() else {
        return true;
    };
    let far = |from: Vec3| {
        points
            .iter()
            .copied()
            .max_by(|a, b| from.distance(*a).total_cmp(&from.distance(*b)))
            .unwrap_or(from)
    };
    let one = far(first);
    let other = far(one);
    let length = one.distance(other);
    let along = (other - one).normalize_or_zero();
    let widest = points
        .iter()
        .map(|p| (*p - one).reject_from_normalized(along).length())
        .fold(0.0, f32::max);
    length <= 0.0 || widest < LINE * length
}
