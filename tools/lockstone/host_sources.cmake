# The sources of a match's host: of the tool library, and of tests that compile them with sanitizers.
set(lockstone_host_sources
  logs/file/resume.cpp
  match/agones.cpp
  match/journal.cpp
  match/match_host.cpp
  match/match_log.cpp
  match/match_socket.cpp
  match/metrics.cpp
  match/metrics_port.cpp
  match/room.cpp
  match/rooms.cpp
  match/secrets.cpp
  match/web_players.cpp
  support/build_text.cpp
  support/tar.cpp)
list(TRANSFORM lockstone_host_sources PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
# A class of it refers to names local to the file.
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/match/match_host.cpp
  PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
