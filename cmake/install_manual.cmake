# Installs manual pages and shell completions, as the built command writes them.
#   in: VINEROW_PROGRAM (a list: an emulator may come first), VINEROW_DATADIR, VINEROW_MANDIR (relative to the prefix, or absolute)

# place(VARIABLE FOLDER): the folder below the prefix and DESTDIR.
function(place variable folder)
  if(NOT IS_ABSOLUTE "${folder}")
    set(folder "${CMAKE_INSTALL_PREFIX}/${folder}")
  endif()
  file(MAKE_DIRECTORY "$ENV{DESTDIR}${folder}")
  set(${variable} "$ENV{DESTDIR}${folder}" PARENT_SCOPE)
endfunction()

place(man1 "${VINEROW_MANDIR}/man1")
file(GLOB old "${man1}/vinerow.1*" "${man1}/vinerow-*.1*")
if(old)
  file(REMOVE ${old})
endif()
message(STATUS "Installing: ${man1}/vinerow.1.gz and one page for each command")
execute_process(COMMAND ${VINEROW_PROGRAM} docs --man --out "${man1}" OUTPUT_VARIABLE pages COMMAND_ERROR_IS_FATAL ANY)
string(STRIP "${pages}" pages)
string(REPLACE "\n" ";" pages "${pages}")
# Without name and time of the file: the same bytes each time.
execute_process(COMMAND gzip -9nf ${pages} COMMAND_ERROR_IS_FATAL ANY)

foreach(completion bash|bash-completion/completions/vinerow zsh|zsh/vendor-completions/_vinerow fish|fish/vendor_completions.d/vinerow.fish)
  string(REGEX MATCH "^(.*)[|](.*)/(.*)$" matched "${completion}")
  set(shell ${CMAKE_MATCH_1})
  set(name ${CMAKE_MATCH_3})
  place(folder "${VINEROW_DATADIR}/${CMAKE_MATCH_2}")
  message(STATUS "Installing: ${folder}/${name}")
  execute_process(COMMAND ${VINEROW_PROGRAM} completion ${shell} OUTPUT_FILE "${folder}/${name}" COMMAND_ERROR_IS_FATAL ANY)
endforeach()
