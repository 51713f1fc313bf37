# cmake -DBIN=<folder of the programs> -DPROGRAMS="<names>" -DSOURCE=<root of the source> -P MakeDocuments.cmake
# Writes doc/man/*.1 and share/bash-completion/viwo, of what the programs say about themselves.
function(ask output program option)
	execute_process(COMMAND ${BIN}/${program} ${option} OUTPUT_VARIABLE text RESULT_VARIABLE status)
	if(NOT status EQUAL 0)
		message(FATAL_ERROR "${program} ${option} failed (${status})")
	endif()
	set(${output} "${text}" PARENT_SCOPE)
endfunction()

separate_arguments(PROGRAMS)
file(READ ${SOURCE}/apps/support/completion.bash completion)
foreach(program ${PROGRAMS})
	ask(page ${program} --print-man)
	file(WRITE ${SOURCE}/doc/man/${program}.1 "${page}")
	ask(table ${program} --print-completion)
	string(APPEND completion "${table}")
endforeach()
file(WRITE ${SOURCE}/share/bash-completion/viwo "${completion}")
