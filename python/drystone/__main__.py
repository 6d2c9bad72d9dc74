"""`python -m drystone` is `drystone`."""

from drystone.cli import main

if __name__ == "__main__":
    main()
