#pragma once
/// Workaround for assertions in assimp 5.2.
///
/// Debian's build has assertions enabled: some broken files would abort the process.
/// assimp_traps.cpp defines the function that assimp calls for a failed assertion. It throws, so
/// that ReadFile returns with an error text. assimp's PLY reader writes and reads beyond its
/// buffers; mesh_ply.h reads PLY instead.
