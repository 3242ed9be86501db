# What stands before every script: a module in the working directory must not pass for a library's.
import sys

sys.path = [folder for folder in sys.path if folder]
MISSING, NO_VOICE = 3, 4


def row(*fields):
    sys.stdout.buffer.write(("\t".join(map(str, fields)) + "\n").encode())


def leave(status, *words):
    print(*words, file=sys.stderr)
    sys.exit(status)


def save(path, samples, rate):
    import wave

    with wave.open(path, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(rate)
        file.writeframes(samples)


def told():
    return sys.stdin.buffer.read().decode("utf-8", "replace")


def espeak_library():
    import ctypes
    import ctypes.util

    # By their usual names first: the search for any other starts a compiler on Linux.
    usual = ["libespeak-ng.so.1", "libespeak-ng.1.dylib", "libespeak-ng.dll"]
    for name in usual:
        try:
            return ctypes.CDLL(name)
        except OSError:
            pass
    name = ctypes.util.find_library("espeak-ng")
    if name:
        return ctypes.CDLL(name)
    leave(MISSING, "no libespeak-ng")


def piper_voices():
    """Voices that are installed as Python packages: name -> path of the model."""
    import importlib.util
    import pathlib
    import pkgutil

    voices = {}
    for module in pkgutil.iter_modules():
        if "piper_voice" in module.name:
            spec = importlib.util.find_spec(module.name)
            for folder in spec.submodule_search_locations or []:
                for model in sorted(pathlib.Path(folder).rglob("*.onnx")):
                    voices.setdefault(model.stem, model)
    return dict(sorted(voices.items()))
