//! From phones to what a head is told to do: Cohen-Massaro coarticulation (HABER 5.2), lips that
//! close when they must, and a face that is alive between the words (HABER 5.4).
//!
//! - [`Tables`]: the data, one row per phone and class, in `data/*.toml`, each row with its source.
//! - [`Speech`]: those tables in terms of one head's controls, worked out once.
//! - [`Track`]: an utterance, offline or growing, that knows the controls at any tick.
//! - [`Listener`]: what the sound says of loudness and stress, for both.
//! - [`Idle`]: blinks, glances, breath, nods and brows; [`State`]: what the face is doing.
//! - [`Correction`], [`LookAhead`]: labels that arrive while they are spoken.
//!
//! Knows nothing of meshes, pixels and sockets; what a control does to a face is rig's affair.
#![forbid(unsafe_code)]

mod blend;
mod contact;
mod correction;
mod idle;
mod prosody;
mod speech;
mod stream;
mod tables;
mod track;

pub use correction::Correction;
pub use idle::{Idle, Manner, State, States};
pub use prosody::{Accent, Delivery, Listener};
pub use speech::{Speech, SpeechError};
pub use stream::{LookAhead, Stream};
pub use tables::{
    ArticulationRow, ClassRow, Contact, ContactTimes, Dominance, DominanceTable, Driven, Glide,
    Group, Lips, Opening, TableError, Tables, Tongue,
};
pub use track::Track;
