// Asks for the status once a second and for a picture after the last one came; rests while the page is not looked at.
"use strict";

const STATUS_MS = 1000;
const PICTURE_MS = 600;
const AFTER_FAULT_MS = 3000;

const at = (id) => document.getElementById(id);
const fixed = (x, digits) => (typeof x === "number" ? x.toFixed(digits) : "?");

function span(seconds) {
  const s = Math.floor(seconds);
  const parts = [[86400, "d"], [3600, "h"], [60, "min"]];
  for (const [size, name] of parts) {
    if (s >= size) return `${(s / size).toFixed(1)} ${name}`;
  }
  return `${s} s`;
}

function list(id, rows) {
  const lines = rows.flatMap(([name, value, kind]) => {
    const term = document.createElement("dt");
    const text = document.createElement("dd");
    term.textContent = name;
    text.textContent = value;
    if (kind) text.className = kind;
    return [term, text];
  });
  at(id).replaceChildren(...lines);
}

function verdict(text, well) {
  at("verdict").textContent = text;
  at("verdict").className = well ? "well" : "ill";
}

function show(s) {
  verdict(s.ok ? "A face is on the screen and moving" : "No moving face is on the screen", s.ok);
  list("parts", Object.entries(s.parts).map(([name, part]) =>
    [name, part.why ?? "well", part.ok ? "well" : "ill"]));
  list("picture", [
    ["a second", fixed(s.window.pictures_per_second, 1)],
    ["shown", s.window.pictures],
    ["tier", s.window.tier ?? "none"],
    ["later than sound", `${fixed(s.window.skew_ms, 1)} ms`],
    ["head ahead by", `${fixed(s.simulation.lead_ms, 0)} ms`],
    ["set up again", s.window.failures],
  ]);
  list("sound", [
    ["device", s.sound.device],
    ["lost", s.sound.losses],
    ["ran dry", s.sound.underruns],
    ["labels too late", s.sound.dropped_labels],
    ["left out", `${fixed(s.sound.dropped_s, 2)} s`],
  ]);
  list("utterances", [
    ["waiting or heard", s.utterances.queue],
    ["accepted", s.utterances.accepted],
    ["finished", s.utterances.finished],
    ["stopped", s.utterances.stopped],
    ["in error", s.utterances.error],
  ]);
  list("process", [
    ["clients", s.clients],
    ["memory", `${fixed(s.rss_mb, 0)} MB`],
    ["running for", span(s.uptime_s)],
    ["version", s.version],
  ]);
}

async function status() {
  let next = STATUS_MS;
  if (!document.hidden) {
    try {
      const answer = await fetch("status.json");
      if (!answer.ok) throw new Error(answer.statusText);
      show(await answer.json());
    } catch {
      verdict("Nobody answers: the program has ended, or is very busy", false);
      next = AFTER_FAULT_MS;
    }
  }
  setTimeout(status, next);
}

function picture() {
  if (document.hidden) {
    setTimeout(picture, STATUS_MS);
    return;
  }
  const next = new Image();
  next.onload = () => {
    next.id = "preview";
    next.alt = "What is on the screen";
    at("preview").replaceWith(next);
    at("caption").textContent = "What is on the screen, twice a second at most";
    setTimeout(picture, PICTURE_MS);
  };
  next.onerror = () => {
    at("caption").textContent = "No picture of the screen can be had";
    setTimeout(picture, AFTER_FAULT_MS);
  };
  next.src = `preview.png?${Date.now()}`;
}

status();
picture();
