//! The head at run time: what it is made of, what moves it, how its mouth is read.
//!
//! | module | holds |
//! |---|---|
//! | `anatomy` | what lies under the skin, as parts to be drawn: bones, muscles, springs |
//! | `anthropometry` | distances between landmarks, as Farkas names them |
//! | `articulation` | what a mouth should do, for any head |
//! | `calibration` | an articulation turned into one head's muscles |
//! | `control` | one number per muscle, jaw, tongue, lid, gaze and head angle |
//! | `expression` | named settings of the muscles, scripts of them, and both over speech |
//! | `file` | a head as a .glb file |
//! | `follow` | how muscles and joints follow what they are told |
//! | `head` | a head as data, with its landmarks, and where its bodies are |
//! | `mesh` | what it is drawn of: skin, parts, the bodies they hang on |
//! | `reference` | the head that is built in |
//! | `muscle` | fibres: linear and sphincter (HABER 5.1) |
//! | `tissue_record` | which tissue a head has, and its mass |
//! | `tissue` | the springs of the skin (HEADSHOP 4.2) |
//! | `jaw`, `tongue` | how they move, and what stops them (HABER 4.1) |
//! | `contact` | lips, teeth, lids and eyeballs stop each other |
//! | `simulation` | steps all of it in time |
//! | `key_frame` | the whole state at an instant |
//! | `subdivision` | the surface that is drawn over the simulated mesh |
//! | `measure` | aperture, width, protrusion, jaw of a key frame |
//! | `quality` | how good a triangle mesh is |
//!
//! Millimetres, seconds and radians; +y up, +z out of the face, +x to the subject's left. Stiffness
//! and damping are per unit of mass. This crate knows neither phones nor pixels.
#![deny(unsafe_code)]

mod anatomy;
mod anthropometry;
mod articulation;
mod calibration;
mod contact;
mod control;
mod expression;
mod file;
mod follow;
mod head;
mod jaw;
mod key_frame;
mod measure;
mod mesh;
mod muscle;
mod quality;
mod reference;
mod simulation;
mod subdivision;
mod tissue;
mod tissue_record;
mod tongue;

pub use anatomy::{Anatomy, SpringKind, SpringLine, undressed};
pub use anthropometry::{Measurement, measurements};
pub use articulation::{Articulation, Tongue};
pub use calibration::{
    Calibration, CalibrationError, Measure, MeasureError, Miss, Reach, Verification,
};
pub use control::{Control, Controls, Muscle};
pub use expression::{Expression, ExpressionError, Library, Mouth, Script};
pub use file::HeadError;
pub use head::{ColourMap, Eye, Feature, Head, Landmark, Layer, Placement, SurfacePoint};
pub use key_frame::{KeyFrame, TICK_RATE};
pub use measure::{Measures, measure};
pub use mesh::{Body, LIP_LEVELS, Lid, Lips, Material, Mesh, Part, Skin, lip_level, normals};
pub use muscle::{
    Axis, Belly, Contraction, Fibre, GridPoint, MuscleGrid, MuscleSurfaces, Space, enclosed_volume,
    rebuild,
};
pub use quality::{EdgeLengths, Quality, edge_lengths};
pub use simulation::{STEP_TICKS, Simulation};
pub use subdivision::{
    Detail, LipStencils, Stencils, Subdivision, SubdivisionError, Topology, fit_control,
    limit_stencils,
};
pub use tissue::{Isa, SpringPass};
pub use tissue_record::{TissueModel, TissueRecord};
