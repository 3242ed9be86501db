//! Where muscles merge: a linear muscle's insertion takes a sphincter's points along (HABER 5.1).

use super::{Contraction, Fibre};
use crate::Muscle;

/// A control point of a sphincter that a linear muscle's insertion takes along.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Merge {
    /// The sphincter's fibre and point.
    pub fibre: usize,
    pub point: usize,
    /// The linear fibre that inserts there, and the share of its pull that arrives.
    pub puller: usize,
    pub share: f32,
}

/// A linear muscle takes the sphincter's points within this distance of its insertion along, mm.
const MERGE_REACH_MM: f32 = 17.0;

/// Where linear muscles merge into a sphincter. Raisers of the upper lip do not reach the lower half of
/// the orbicularis oris, depressors of the lower lip not the upper one; what moves the brows merges
/// into the orbital part of the orbicularis oculi.
pub(crate) fn merges(fibres: &[Fibre]) -> Vec<Merge> {
    let mut merges = Vec::new();
    for (f, sphincter) in fibres.iter().enumerate() {
        if !matches!(sphincter.contraction, Contraction::Sphincter { .. }) {
            continue;
        }
        for (p, place) in sphincter.points.iter().enumerate() {
            let start = merges.len();
            for (l, linear) in fibres.iter().enumerate() {
                let apart = !merge_into(linear.muscle, sphincter.muscle);
                let Some(&insertion) = linear.points.last() else {
                    continue;
                };
                let near = 1.0 - insertion.distance(*place) / MERGE_REACH_MM;
                if linear.contraction == Contraction::Linear && !apart && near > 0.0 {
                    merges.push(Merge {
                        fibre: f,
                        point: p,
                        puller: l,
                        share: near.sqrt(),
                    });
                }
            }
            // Fibres of one muscle share the point: together they pull no harder than one.
            for i in start..merges.len() {
                let muscle = fibres[merges[i].puller].muscle;
                let alike: f32 = merges[start..]
                    .iter()
                    .filter(|m| fibres[m.puller].muscle == muscle)
                    .map(|m| m.share)
                    .sum();
                merges[i].share *= merges[i].share / alike.max(1.0);
            }
        }
    }
    merges
}

/// Whether fibres of a linear muscle end among those of a sphincter.
const fn merge_into(linear: Muscle, sphincter: Muscle) -> bool {
    use Muscle::{
        CorrugatorSupercilii, DepressorLabiiInferioris, DepressorSeptiNasi, DepressorSupercilii,
        DilatorNaris, FrontalisInner, FrontalisOuter, LevatorLabiiSuperioris,
        LevatorLabiiSuperiorisAlaequeNasi, Masseter, Mentalis, Nasalis, OrbicularisOculiOrbital,
        OrbicularisOculiPalpebral, OrbicularisOrisInferior, OrbicularisOrisSuperior, Platysma,
        Procerus, Temporalis, ZygomaticusMinor,
    };
    match linear {
        LevatorLabiiSuperioris | LevatorLabiiSuperiorisAlaequeNasi | ZygomaticusMinor => {
            matches!(sphincter, OrbicularisOrisSuperior)
        }
        DepressorLabiiInferioris => matches!(sphincter, OrbicularisOrisInferior),
        FrontalisInner | FrontalisOuter | CorrugatorSupercilii | DepressorSupercilii => {
            matches!(sphincter, OrbicularisOculiOrbital)
        }
        Mentalis | Procerus | Nasalis | DilatorNaris | DepressorSeptiNasi | Platysma | Masseter
        | Temporalis => false,
        _ => !matches!(
            sphincter,
            OrbicularisOculiOrbital | OrbicularisOculiPalpebral
        ),
    }
}
