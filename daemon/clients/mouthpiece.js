// Speaks through a running `mouthpiece run --listen ws://127.0.0.1:7718` from a page, or from Node 22 or newer. No dependencies.
//
//     import { Mouthpiece } from "./mouthpiece.js";
//     const face = await Mouthpiece.connect("ws://127.0.0.1:7718");
//     await face.speak({ labels: [{ start: 0, end: 0.3, phone: "aa" }], sound: { samples, rate: 22050 } });
//
// The page must come from the daemon's own host, or its origin must be in `origins` of the daemon's [wire] ("null" for a page that is
// opened as a file).

export class Mouthpiece {
  #socket;
  #count = 0;
  #waiting = new Map();

  // Where the daemon listens, and its token where it has one.
  static connect(url, { token, onevent = () => {} } = {}) {
    const socket = new WebSocket(url);
    const face = new Mouthpiece(socket, onevent);
    return new Promise((resolve, reject) => {
      socket.onerror = () => reject(new Error(`no daemon answers at ${url}`));
      socket.onopen = () => {
        if (token !== undefined) face.send({ type: "auth", token });
        resolve(face);
      };
    });
  }

  constructor(socket, onevent) {
    this.#socket = socket;
    socket.onmessage = ({ data }) => {
      const answer = JSON.parse(data);
      onevent(answer);
      const failed = answer.type === "error" && answer.fatal;
      const refused = answer.type === "error" && answer.id === undefined;
      if (refused) {
        // About no utterance: the last one that was begun was not taken.
        const last = [...this.#waiting.keys()].pop();
        this.#end(last, answer);
      } else if (failed || answer.type === "finished" || answer.type === "stopped") {
        this.#end(answer.id, answer);
      }
    };
    socket.onclose = () => {
      for (const id of [...this.#waiting.keys()]) {
        this.#end(id, { type: "error", id, message: "the daemon has gone" });
      }
    };
  }

  #end(id, answer) {
    const waiting = this.#waiting.get(id);
    this.#waiting.delete(id);
    if (answer.type === "error") waiting?.reject(new Error(answer.message));
    else waiting?.resolve(answer);
  }

  // Any message: express, look, state, stop, ping …
  send(message) {
    this.#socket.send(JSON.stringify(message));
  }

  // Labels in seconds, sound as Float32Array of one channel; resolves when it was heard or stopped.
  speak({ labels, sound, alphabet = "timit", caption }) {
    const id = `js-${++this.#count}`;
    const done = new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
    const audio = sound && { rate: sound.rate, channels: 1, format: "f32" };
    this.send({ type: "begin", id, alphabet, ...(audio && { audio }) });
    if (caption !== undefined) this.send({ type: "caption", text: caption });
    this.send({ type: "phones", phones: labels });
    if (sound) {
      const { samples } = sound;
      // Binary frames are sound of the open utterance; a quarter of a second in each.
      const step = Math.ceil(sound.rate / 4);
      for (let at = 0; at < samples.length; at += step) this.#socket.send(samples.slice(at, at + step));
    }
    this.send({ type: "end" });
    return done;
  }

  // Silences the face, whoever speaks.
  stop() {
    this.send({ type: "stop" });
  }

  close() {
    this.#socket.close();
  }
}
