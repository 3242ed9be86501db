# Finds where the words and phones of a text are in 16 kHz sound (raw 16 bit, the file argv[1]).
# Standard input: a line for each word, the word and how it may be said, phones apart by spaces.
try:
    from pocketsphinx import Decoder
except ImportError as error:
    leave(MISSING, error)

RATE, FRAME = 16000, 160
WIDE = 1e-100  # wider still, and scores underflow: words get lost again

# How well the sound fits, a frame within words. What was said scored -7 to -36 (a robotic voice
# and one with a cold are the low end), another text of the same length -48 to -74.
POOR, WRONG = -30, -45

with open(sys.argv[1], "rb") as file:
    sound = file.read()
words = [line.split("\t") for line in told().splitlines()]
text = " ".join(word for word, _ in words)


def attempt(padding, **options):
    """Phones, or none where not all words found a place."""
    decoder = Decoder(samprate=RATE, loglevel="FATAL", **options)
    unknown = []
    for word, phones in dict(words).items():
        if decoder.lookup_word(word) is None:
            if not phones:
                leave(1, f"neither it nor we know how to say `{word}`; spell it as words")
            unknown.append(word)
            decoder.add_word(word, phones, True)
    silence = bytes(2 * padding * FRAME)
    padded = silence + sound + silence

    def listen():
        decoder.start_utt()
        decoder.process_raw(padded, full_utt=True)
        decoder.end_utt()

    # Without a silence to begin with, the search often fails to end.
    decoder.set_align_text("<sil> " + text)
    try:
        listen()
        found = decoder.hyp()
        # What ends early has left words out.
        if found is None or len(found.hypstr.split()) != len(words):
            return None
        decoder.set_alignment()
        listen()
    except RuntimeError:
        return None
    rows, score, frames = [], 0, 0
    for word in decoder.get_alignment():
        if not word.name.startswith("<"):
            score += word.score
            frames += word.duration
        for phone in word:
            start = max(phone.start - padding, 0) * FRAME
            rows.append((start, max(phone.start + phone.duration - padding, 0) * FRAME, phone.name))
    fit = score / max(frames, 1)
    return (rows, unknown, fit) if fit > WRONG else None


wide = dict(beam=WIDE, pbeam=WIDE, wbeam=WIDE, bestpath=False)
tries = [(20, wide), (0, wide), (50, wide), (20, {}), (0, {}), (50, {}), (100, wide)]
for number, (padding, options) in enumerate(tries, 1):
    found = attempt(padding, **options)
    if found:
        break
else:
    leave(NO_VOICE, "no place for all words")
rows, unknown, fit = found
row("rate", RATE)
for start, end, name in rows:
    row("phone", start, end, name)
if fit < POOR:
    row("note", "the text fits the sound poorly; check that all of it is said there, and nothing else")
row("note", f"{len(words)} words, attempt {number} of {len(tries)}")
if unknown:
    row("note", "said by letter-to-sound rules, for its dictionary lacks them: " + ", ".join(unknown))
sys.stdout.buffer.flush()
