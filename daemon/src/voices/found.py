# Which engines this Python reaches: a line for each, its name and what there is of it.
import importlib.metadata


def version(package):
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


if version("piper-tts"):
    voices = ", ".join(piper_voices()) or "no voice package: give --voice MODEL.onnx"
    lacks = "" if version("onnx") else "; lacks onnx: pip install 'piper-tts[alignment]'"
    row("piper", f"{version('piper-tts')} ({voices}){lacks}")
if version("pocketsphinx"):
    row("pocketsphinx", version("pocketsphinx") + ", for --text with --audio")
sys.stdout.buffer.flush()
library = espeak_library()  # ends here where there is none
import ctypes

library.espeak_Info.restype = ctypes.c_char_p
row("espeak-ng", library.espeak_Info(None).decode())
