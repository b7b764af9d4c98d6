# Copyright file and changelog of a Debian package. Nothing outside packages: their prefix is /usr below a staging folder.
#   in: VINEROW_SOURCE_DIR, VINEROW_VERSION, VINEROW_CONTACT, VINEROW_PACKAGE
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr" OR "$ENV{DESTDIR}" STREQUAL "")
  return()
endif()
set(folder "$ENV{DESTDIR}/usr/share/doc/${VINEROW_PACKAGE}")

# indented(VARIABLE FILE UNWANTED): its lines as a field of a copyright file, without those that match UNWANTED and first empty ones.
function(indented variable file unwanted)
  file(STRINGS "${file}" lines)
  set(text "")
  foreach(line IN LISTS lines)
    if(line STREQUAL "" AND NOT text STREQUAL "")
      string(APPEND text " .\n")
    elseif(NOT line STREQUAL "" AND NOT line MATCHES "${unwanted}")
      string(APPEND text " ${line}\n")
    endif()
  endforeach()
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

file(STRINGS "${VINEROW_SOURCE_DIR}/LICENSE" copyright REGEX "^Copyright")
string(REGEX REPLACE "^Copyright [(]c[)] " "" copyright "${copyright}")
indented(bsd_3_clause "${VINEROW_SOURCE_DIR}/LICENSE" "^(Copyright|BSD 3-Clause License)")
indented(expat "${VINEROW_SOURCE_DIR}/tools/replay/page/three_licence.txt" "^(three[.]js, which|The MIT License|Copyright)")
configure_file("${CMAKE_CURRENT_LIST_DIR}/copyright.in" "${folder}/copyright" @ONLY)

# The day of the last commit, or SOURCE_DATE_EPOCH: the same sources give the same package.
set(seconds "$ENV{SOURCE_DATE_EPOCH}")
if(seconds STREQUAL "")
  execute_process(COMMAND git -C "${VINEROW_SOURCE_DIR}" log -1 --format=%ct OUTPUT_VARIABLE seconds ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
if(seconds STREQUAL "")
  string(TIMESTAMP seconds "%s" UTC)
endif()
execute_process(COMMAND date -u -R -d "@${seconds}" OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
file(WRITE "${folder}/changelog" "vinerow (${VINEROW_VERSION}) bookworm; urgency=medium

  * Changes: /usr/share/doc/vinerow/CHANGELOG.md.

 -- ${VINEROW_CONTACT}  ${date}
")
execute_process(COMMAND gzip -9nf "${folder}/changelog" COMMAND_ERROR_IS_FATAL ANY)
