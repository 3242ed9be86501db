//! End-to-end tests: the release build of `mouthpiece`, run as its users run it.
//!
//! | module | guards |
//! |---|---|
//! | `mouth` | what a viewer sees: lips meet in /p b m/, the mouth opens in open vowels |
//! | `expression` | faces over speech, scripts of them |
//! | `backdrop` | what is behind the head, and alpha |
//! | `export` | videos: in step, the same every time, whole or not there |
//! | `formats` | alpha in WebM, pictures for pipes and cameras |
//! | `jobs` | lists of videos: failures, resuming, shares of a list, full disks |
//! | `head` | head files: spoken with, looked at, refused |
//! | `head_fit` | scans made heads, and what is no scan refused |
//! | `head_landmarks` | the marking window where there is no display |
//! | `health` | what supervisors, Prometheus and browsers are told; faults that heal |
//! | `labels` | label files of every sad kind, and the round trip |
//! | `cage` | the recipe for a kiosk under Wayland |
//! | `captions` | words under the face: what `say --text` says |
//! | `closures` | lips that close at every rate, over many sentences; look-ahead |
//! | `device` | the sound device that goes and comes back |
//! | `puppet` | other avatars, driven over UDP |
//! | `sound` | sound files of every kind |
//! | `voices` | text instead of labels: speech engines, recordings |
//! | `config` | the configuration file: checked, printed, under flags |
//! | `kiosk` | a face that is watched over: systemd, a changed configuration, the end |
//! | `reload` | no picture lost over a configuration that is replaced |
//! | `vanished` | a client over TCP that is gone without a word |
//! | `usage` | exit statuses, help, what doctor and bench print |
//! | `show` | what lies under the skin, drawn |
//! | `still` | pictures against golden ones |
//! | `readme` | that the README's commands and conversation work as printed |
//! | `house` | the style of the source, and licences |

#![forbid(unsafe_code)]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test that cannot go on has failed, and says where"
)]

mod backdrop;
mod cage;
mod captions;
mod closures;
mod config;
mod device;
mod export;
mod expression;
mod formats;
mod graphics;
mod head;
mod head_fit;
mod head_landmarks;
mod health;
mod house;
mod jobs;
mod kiosk;
mod labels;
mod mouth;
mod outline;
mod puppet;
mod readme;
mod reload;
mod show;
mod sound;
mod still;
mod usage;
mod vanished;
mod voices;
