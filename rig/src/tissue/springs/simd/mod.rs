//! The passes over all springs, on as many lanes as the processor has; the only unsafe code of the crate.
//!
//! Why unsafe: neighbours are fetched without a check of bounds (the indices are checked once, when
//! [`Mesh`] is made, and cannot change after), and vector instructions of x86-64 may only run where the
//! processor has them (asked once, by [`Isa::best`]). One kernel is written over the trait [`Lanes`] and
//! compiled three times: for AVX-512, for AVX2 with FMA, and for any machine.
//!
//! | module | holds |
//! |---|---|
//! | `mesh` | nodes in blocks of 16, the springs of a block in rows |
//! | `kernel` | springs to velocities, velocities to places |
//! | `lanes` | what the kernel asks of a vector |
//! | `avx512`, `avx2`, `portable` | the vectors |
#![allow(
    unsafe_code,
    reason = "unchecked fetches and vector instructions, see above"
)]

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod kernel;
mod lanes;
mod mesh;
mod portable;

use glam::Vec3A;
pub(super) use kernel::{Kick, MOST, SOFTEN};
pub(super) use mesh::{Ground, Hold, Mesh, Neighbour};

use crate::tissue::Nodes;

/// Which instructions the passes use. None can be named that this processor has not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Isa(Set);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Isa {
    /// The widest that this processor has.
    #[must_use]
    pub fn best() -> Self {
        Self::all()[0]
    }

    /// All that this processor has, the widest first.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f") {
                all.push(Self(Set::Avx512));
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                all.push(Self(Set::Avx2));
            }
        }
        all.push(Self(Set::Portable));
        all
    }

    /// How many floats it works on at once.
    #[must_use]
    pub fn lanes(self) -> usize {
        match self.0 {
            Set::Portable => 4,
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => 8,
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => 16,
        }
    }
}

/// Runs `$kernel::<L>($($arg),*)` on the lanes of an [`Isa`].
macro_rules! on {
    ($isa:expr, $kernel:ident($($arg:expr),*)) => {
        match $isa.0 {
            // SAFETY: only `Isa::all` makes one, where the processor has it.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { avx512::$kernel($($arg),*) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: as above.
            Set::Avx2 => unsafe { avx2::$kernel($($arg),*) },
            Set::Portable => kernel::$kernel::<portable::Four>($($arg),*),
        }
    };
}

/// Velocities after the forces of a step, and per volume row the gradient of the volume.
///
/// # Panics
/// When `nodes`, `shift` or `gradient` are not of the size that `mesh` was made for.
pub(super) fn kick(
    isa: Isa,
    mesh: &Mesh,
    nodes: &mut Nodes,
    shift: &[Vec3A],
    gradient: &mut [Vec3A],
    kick: &Kick,
) {
    mesh.check(nodes, shift.len(), gradient.len());
    on!(isa, kick(mesh, nodes, shift, gradient, kick));
}

/// Places after a step with these velocities.
pub(super) fn drift(isa: Isa, nodes: &mut Nodes, step_s: f32) {
    on!(isa, drift(nodes, step_s));
}

/// Forces of the edges alone, for measuring; `law` is slack and blend of [`Kick`].
///
/// # Panics
/// When `nodes` or `force` are not of the size that `mesh` was made for.
pub(super) fn stretch(isa: Isa, mesh: &Mesh, nodes: &Nodes, force: &mut [Vec3A], law: [f32; 2]) {
    mesh.check(nodes, mesh.places(), mesh.gradients());
    assert_eq!(force.len(), nodes.place.len(), "one force per node");
    on!(isa, stretch(mesh, nodes, force, law));
}
