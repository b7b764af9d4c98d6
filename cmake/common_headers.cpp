// Has nothing of its own: its precompiled header is used by the parts (cmake/targets.cmake).
