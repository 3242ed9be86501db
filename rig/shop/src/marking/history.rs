//! Undo and redo, by keeping all of what was set before each deed: sixty points are a page of memory.

use glam::Vec3;

/// Deeds that can be taken back: a whole session of placing and correcting.
const DEEDS: usize = 500;

type Marks = Vec<Option<Vec3>>;

/// What was, and what was taken back.
#[derive(Debug, Default)]
pub(super) struct History {
    past: Vec<Marks>,
    future: Vec<Marks>,
}

impl History {
    /// Before a deed.
    pub(super) fn push(&mut self, now: &Marks) {
        if self.past.len() >= DEEDS {
            self.past.remove(0);
        }
        self.past.push(now.clone());
        self.future.clear();
    }

    /// A deed that changed nothing is none.
    pub(super) fn forget_if_same(&mut self, now: &Marks) {
        if self.past.last() == Some(now) {
            self.past.pop();
        }
    }

    pub(super) fn undo(&mut self, now: &mut Marks) -> bool {
        swap(&mut self.past, &mut self.future, now)
    }

    pub(super) fn redo(&mut self, now: &mut Marks) -> bool {
        swap(&mut self.future, &mut self.past, now)
    }
}

fn swap(from: &mut Vec<Marks>, to: &mut Vec<Marks>, now: &mut Marks) -> bool {
    let Some(then) = from.pop() else {
        return false;
    };
    to.push(std::mem::replace(now, then));
    true
}
