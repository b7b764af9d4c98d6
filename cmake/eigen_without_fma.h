#pragma once
// On aarch64 Eigen multiplies and adds in one instruction, which rounds once where every other processor rounds twice. Included
// before everything else (compile_options.cmake), this gives it two instructions: the same bits as on x86-64.
#if defined(__aarch64__) && defined(__cplusplus)
#include <arm_neon.h>
#define vfma_f32(c, a, b) vadd_f32((c), vmul_f32((a), (b)))
#define vfmaq_f32(c, a, b) vaddq_f32((c), vmulq_f32((a), (b)))
#define vfmaq_f64(c, a, b) vaddq_f64((c), vmulq_f64((a), (b)))
#define vfmaq_n_f32(c, a, b) vaddq_f32((c), vmulq_n_f32((a), (b)))
#define vfmaq_n_f64(c, a, b) vaddq_f64((c), vmulq_n_f64((a), (b)))
#define vfmaq_laneq_f32(c, a, b, lane) vaddq_f32((c), vmulq_laneq_f32((a), (b), (lane)))
#define vfmaq_laneq_f64(c, a, b, lane) vaddq_f64((c), vmulq_laneq_f64((a), (b), (lane)))
#endif
