#pragma once
/// A trap of assimp 5.2 and how load_mesh steps round it.
///
/// Debian's build has assertions on: some broken files would abort the process. assimp_traps.cpp
/// defines the function that assimp calls then, so that it throws and ReadFile returns with an
/// error text. PLY, whose reader in assimp writes and reads beyond its buffers, is read by
/// mesh_ply.h instead.
