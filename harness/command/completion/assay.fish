# Completion of assay in fish. The program says what may follow; a word with `*` stands for files.
function __assay_offers
    set -l words (commandline -opc) (commandline -ct)
    set -l before (string replace -r '[^=]*$' '' -- $words[-1])
    for line in ($words[1] __complete $words[2..] 2>/dev/null)
        set -l word (string split -m 1 \t -- $line)[1]
        if not string match -q '*\**' -- $word
            echo $line
            continue
        end
        for path in (string replace -r '.*=' '' -- $words[-1])*
            if test -d $path
                echo $before$path/
            else if string match -q -- $word $path
                echo $before$path
            end
        end
    end
end
complete -c assay -f -a '(__assay_offers)'
