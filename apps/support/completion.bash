# Completion of the programs of viwo in bash. The tables below are made of what --help says ("cmake --build build --target documents"):
# _viwo_words[PROGRAM] and _viwo_words[PROGRAM COMMAND] are the options and commands that may follow,
# _viwo_values[PROGRAM OPTION] is what may follow an option ("@" for arguments without one): how many values (*: any number), and their kind.

# -g: completions are often loaded inside of a function.
declare -gA _viwo_words=() _viwo_values=()

# _viwo_files [EXTENSION...]: files so named, and folders on the way to them.
_viwo_files() {
	compopt -o filenames 2>/dev/null
	local extension
	mapfile -t COMPREPLY < <({
		compgen -d -- "$cur"
		if [ $# -eq 0 ]; then compgen -f -- "$cur"; fi
		for extension; do compgen -f -X "!*.$extension" -- "$cur"; done
	} | LC_ALL=C sort -u)
}

# _viwo_list WORD...: one more of the words, behind a comma.
_viwo_list() {
	local before=${cur%"${cur##*,}"} words=() word
	for word; do [[ ,$before == *,$word,* ]] || words+=("$word"); done
	compopt -o nospace 2>/dev/null
	mapfile -t COMPREPLY < <(compgen -P "$before" -W "${words[*]}" -- "${cur##*,}")
}

# _viwo_offer COUNT KIND [WORD...]: an entry of _viwo_values.
_viwo_offer() {
	local kind=$2
	shift 2
	case $kind in
	WORDS) mapfile -t COMPREPLY < <(compgen -W "$*" -- "$cur") ;;
	LIST) _viwo_list "$@" ;;
	FILE) _viwo_files "$@" ;;
	DIR)
		compopt -o filenames 2>/dev/null
		mapfile -t COMPREPLY < <(compgen -d -- "$cur")
		;;
	esac
}

_viwo_complete() {
	local cur=${COMP_WORDS[COMP_CWORD]} key=${COMP_WORDS[0]##*/} option='' wanted=0 i word entry
	COMPREPLY=()
	[ "$cur" = = ] && cur=''
	# Which command this is, and how many values the last option still wants.
	for ((i = 1; i < COMP_CWORD; i++)); do
		word=${COMP_WORDS[i]}
		if [[ $word == -?* && ! $word =~ ^-[0-9.]+$ ]]; then
			option=$word
			entry=${_viwo_values["$key $option"]-0}
			wanted=${entry%% *}
		elif [[ $word == = ]]; then
			continue
		elif [[ $wanted == 0 && -n ${_viwo_words["$key $word"]-} ]]; then
			key+=" $word" option=''
		elif [[ $wanted != 0 && $wanted != '*' ]]; then
			((wanted--))
		fi
	done
	if [[ $wanted != 0 && $cur != -* ]]; then
		entry=${_viwo_values["$key $option"]}
	elif [[ $cur != -* ]]; then
		entry=${_viwo_values["$key @"]-}
	else
		entry=''
	fi
	if [[ -n $entry ]]; then
		local words
		read -ra words <<<"$entry"
		_viwo_offer "${words[@]}"
	else
		mapfile -t COMPREPLY < <(compgen -W "${_viwo_words["$key"]-}" -- "$cur")
	fi
}

