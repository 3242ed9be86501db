# Speaks by espeak-ng's library: sound into the file argv[1], phones with their samples to stdout.
import array
import ctypes

# Of espeak-ng's speak_lib.h.
SYNCHRONOUS, PHONEME_EVENTS, IPA, DONT_EXIT = 2, 1, 2, 0x8000
UTF8 = 1
LIST_TERMINATED, PHONEME = 0, 7


class Event(ctypes.Structure):
    _fields_ = [
        ("type", ctypes.c_int),
        ("unique_identifier", ctypes.c_uint),
        ("text_position", ctypes.c_int),
        ("length", ctypes.c_int),
        ("audio_position", ctypes.c_int),
        ("sample", ctypes.c_int),
        ("user_data", ctypes.c_void_p),
        ("name", ctypes.c_char * 8),
    ]


CALLBACK = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(Event)
)
samples, phones = array.array("h"), []


@CALLBACK
def callback(sound, count, events):
    if sound and count > 0:
        samples.extend(sound[:count])
    index = 0
    while events[index].type != LIST_TERMINATED:
        event = events[index]
        if event.type == PHONEME:
            phones.append((event.name.decode("utf-8", "ignore"), event.sample))
        index += 1
    return 0


library = espeak_library()
library.espeak_Synth.argtypes = [
    ctypes.c_char_p, ctypes.c_size_t, ctypes.c_uint, ctypes.c_int,
    ctypes.c_uint, ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p,
]
rate = library.espeak_Initialize(SYNCHRONOUS, 0, None, PHONEME_EVENTS | IPA | DONT_EXIT)
if rate <= 0:
    leave(1, "it does not find its data (Debian: espeak-ng-data)")
library.espeak_SetSynthCallback(callback)
voice = sys.argv[2] or "en-us"
if library.espeak_SetVoiceByName(voice.encode()) != 0:
    leave(NO_VOICE, "`espeak-ng --voices` lists them")
text = told().encode()
library.espeak_Synth(text, len(text) + 1, 0, 1, 0, UTF8, None, None)
library.espeak_Synchronize()
save(sys.argv[1], samples.tobytes(), rate)
row("rate", rate)
# Marks where the language changes are no phones.
phones = [phone for phone in phones if not phone[0].startswith("(")]
ends = [start for _, start in phones[1:]] + [len(samples)]
for (name, start), end in zip(phones, ends):
    row("phone", start, end, name)
sys.stdout.buffer.flush()
library.espeak_Terminate()
