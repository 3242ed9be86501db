//! What one video leaves for the next: heads that were read, the graphics device, and a head on it.
//!
//! Reading the built-in head takes a moment, painting its maps and turning shaders into machine code half a second:
//! as long as a short sentence takes to draw.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use mouthpiece_render::{Batch, Gpu};
use mouthpiece_rig::{Head, TissueModel};

use super::job::Job;
use crate::cli::{CastArgs, Size, TierArg};
use crate::pipeline::Cast;

/// Heads that are kept, some 20 MB each; a list that uses more by turns reads them again.
const HEADS_MAX: usize = 4;

/// Which head, and what moves its skin.
type HeadKey = (Option<PathBuf>, Option<TissueModel>);

/// What all workers of a list share.
#[derive(Default)]
pub struct Studio {
    /// Last used last.
    casts: Mutex<Vec<(HeadKey, Cast)>>,
    gpu: Mutex<Option<Gpu>>,
}

impl Studio {
    /// The head that is asked for; read once. Others who ask wait meanwhile, since they mostly want the same.
    pub fn cast(&self, args: &CastArgs) -> anyhow::Result<Cast> {
        let key = (args.head.clone(), args.tissue.map(TissueModel::from));
        let mut casts = self.casts.lock().unwrap_or_else(PoisonError::into_inner);
        let entry = match casts.iter().position(|(known, _)| *known == key) {
            Some(at) => casts.remove(at),
            None => (key, Cast::load(args)?),
        };
        let cast = entry.1.clone();
        if casts.len() >= HEADS_MAX {
            casts.remove(0);
        }
        casts.push(entry);
        Ok(cast)
    }

    /// The graphics device. A card is one for all, and takes turns by itself; in software a device has one queue that
    /// draws one picture at a time, so that everybody has one of their own.
    pub fn gpu(&self) -> anyhow::Result<Gpu> {
        let mut gpu = self.gpu.lock().unwrap_or_else(PoisonError::into_inner);
        match gpu.as_ref().filter(|gpu| !gpu.is_lost()) {
            Some(gpu) if gpu.is_software() => Ok(gpu.another()?),
            Some(gpu) => Ok(gpu.clone()),
            None => Ok(gpu.insert(Gpu::headless()?).clone()),
        }
    }
}

/// A head on a device, ready to be drawn.
pub struct Stage {
    batch: Batch,
    head: Arc<Head>,
    size: Size,
    tier: TierArg,
}

impl Stage {
    /// As `job` needs it.
    pub fn new(gpu: &Gpu, job: &Job) -> anyhow::Result<Self> {
        let (head, size, tier) = (&job.cast.head, job.size, job.look.tier);
        Ok(Self {
            batch: Batch::new(gpu, head, (size.width, size.height), tier.into())?,
            head: Arc::clone(head),
            size,
            tier,
        })
    }

    /// Whether `job` can be drawn on it.
    pub fn suits(&self, job: &Job) -> bool {
        Arc::ptr_eq(&self.head, &job.cast.head)
            && (self.size, self.tier) == (job.size, job.look.tier)
    }

    /// What draws.
    pub fn batch(&mut self) -> &mut Batch {
        &mut self.batch
    }
}
