//! The live face.
mod clock;
mod conductor;
mod face;
mod frames;
mod score;
mod sound;
mod time;
mod utterance;
