//! The mouse pointer on a full screen: there while it moves, and a little longer.

/// When the pointer is to be seen.
#[derive(Debug)]
pub(super) struct Cursor {
    moved_ns: i64,
    visible: bool,
}

impl Cursor {
    /// The window has just opened, with the pointer on it.
    pub(super) fn new(now_ns: i64) -> Self {
        Self {
            moved_ns: now_ns,
            visible: true,
        }
    }

    /// It has moved. Some: show it.
    pub(super) fn moved(&mut self, now_ns: i64) -> Option<bool> {
        self.moved_ns = now_ns;
        (!std::mem::replace(&mut self.visible, true)).then_some(true)
    }

    /// Time has passed; it goes away after `idle_s`, never where that is 0. Some: show it or not.
    pub(super) fn rest(&mut self, now_ns: i64, idle_s: i64) -> Option<bool> {
        let visible = idle_s == 0 || now_ns - self.moved_ns < idle_s * 1_000_000_000;
        (std::mem::replace(&mut self.visible, visible) != visible).then_some(visible)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: i64 = 1_000_000_000;

    #[test]
    fn it_goes_when_it_rests_and_comes_when_it_moves() {
        let mut cursor = Cursor::new(0);
        assert_eq!(cursor.rest(2 * S, 3), None);
        assert_eq!(cursor.rest(3 * S, 3), Some(false));
        assert_eq!(cursor.rest(4 * S, 3), None);
        assert_eq!(cursor.moved(5 * S), Some(true));
        assert_eq!(cursor.moved(6 * S), None);
        assert_eq!(cursor.rest(8 * S, 3), None);
        assert_eq!(cursor.rest(9 * S, 3), Some(false));
        // The configuration has changed.
        assert_eq!(cursor.rest(10 * S, 0), Some(true));
    }
}
