"""What a lab's own watchers see: figures for Prometheus, a log for people and machines, signs of life for systemd."""
