# Eigen's kernels for aarch64 join a product and a sum to one instruction, which rounds once, take three packets of rows at a time
# and sum three floats from the other end: other bits than on x86-64. A copy of Eigen in the build folder, found before the original,
# computes as on x86-64. It is a copy of every header, since they include each other by where they lie.
get_target_property(eigen_original Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
set(VINEROW_EIGEN ${CMAKE_BINARY_DIR}/eigen)
file(COPY ${eigen_original}/Eigen DESTINATION ${VINEROW_EIGEN} REGEX "arch/NEON/(PacketMath|GeneralBlockPanelKernel)[.]h$" EXCLUDE)

# replace_in_header(TIMES OLD NEW): in the variable `header`, NEW in place of each OLD, of which there must be TIMES.
function(replace_in_header times old new)
  string(REPLACE "${old}" "" without "${header}")
  string(LENGTH "${header}" length)
  string(LENGTH "${without}" length_without)
  string(LENGTH "${old}" length_old)
  math(EXPR found "(${length} - ${length_without}) / ${length_old}")
  if(NOT found EQUAL times)
    message(FATAL_ERROR "The Eigen in ${eigen_original} is not 3.4.0, the one that ${CMAKE_CURRENT_FUNCTION_LIST_FILE} makes compute "
                        "on aarch64 as on x86-64: a header of its NEON kernels holds ${found} times, not ${times}:\n${old}")
  endif()
  string(REPLACE "${old}" "${new}" edited "${header}")
  set(header "${edited}" PARENT_SCOPE)
endfunction()

# write_header(NAME): an equal one stays, so that nothing is compiled again for it.
function(write_header name)
  set(target ${VINEROW_EIGEN}/${name})
  set(present "")
  if(EXISTS ${target})
    file(READ ${target} present)
  endif()
  if(NOT present STREQUAL header)
    file(WRITE ${target} "${header}")
  endif()
endfunction()

file(READ ${eigen_original}/Eigen/src/Core/arch/NEON/PacketMath.h header)
# A product and a sum are two instructions.
replace_in_header(1 "#define EIGEN_HAS_SINGLE_INSTRUCTION_MADD\n" "")
replace_in_header(2 "#ifdef __ARM_FEATURE_FMA\n" "#if 0\n")
replace_in_header(1 "return vmlaq_f32(c,a,b);" "return vaddq_f32(c, vmulq_f32(a,b));")
replace_in_header(1 "return vmla_f32(c,a,b);" "return vadd_f32(c, vmul_f32(a,b));")
replace_in_header(1 "return vmlaq_f64(c,a,b);" "return vaddq_f64(c, vmulq_f64(a,b));")
# No packets of two floats.
replace_in_header(1 "  typedef Packet4f type;\n  typedef Packet2f half;\n  enum\n  {\n    Vectorizable = 1,\n    AlignedOnScalar = 1,\n    size = 4,\n    HasHalfPacket = 1,\n"
                    "  typedef Packet4f type;\n  typedef Packet4f half;\n  enum\n  {\n    Vectorizable = 1,\n    AlignedOnScalar = 1,\n    size = 4,\n    HasHalfPacket = 0,\n")
replace_in_header(1 "  typedef float type;\n  typedef Packet2f half;\n  typedef Packet4i integer_packet;\n"
                    "  typedef float type;\n  typedef Packet4f half;\n  typedef Packet4i integer_packet;\n")
write_header(Eigen/src/Core/arch/NEON/PacketMath.h)

file(READ ${eigen_original}/Eigen/src/Core/arch/NEON/GeneralBlockPanelKernel.h header)
# No kernels of its own: the general ones, as on x86-64.
replace_in_header(1 "#if EIGEN_ARCH_ARM64\n" "#if 0\n")
write_header(Eigen/src/Core/arch/NEON/GeneralBlockPanelKernel.h)

# Before the include folders of all targets, of which OMPL's name the original too.
include_directories(SYSTEM BEFORE ${VINEROW_EIGEN})
